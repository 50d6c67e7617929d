// SPDX-License-Identifier: MIT
// What this plugin needs to know of GDNative 1.0, the C interface of Godot 3, on 64-bit machines. Debian has no package of Godot's
// headers. The facts are those of modules/gdnative/gdnative_api.json and modules/gdnative/include in the sources of Godot 3.2.3: a
// function's number is its position in the list "core" of version 1.0. Newer functions are in lists of their own, behind `next`.
#pragma once

#include <cstdint>
#include <type_traits>

namespace godot_api {

// Godot's values, as the bytes that they are. Godot's C declarations are arrays of bytes too, and so a Vector3 travels in the same
// registers (those of whole numbers) on both sides.
template <int Size>
struct Bytes {
  alignas(Size % 8 == 0 ? 8 : 4) std::uint8_t bytes[Size];
};
using Variant = Bytes<24>;
using String = Bytes<8>;
using CharString = Bytes<8>;
using Vector3 = Bytes<12>;     // float x, y, z
using Quaternion = Bytes<16>;  // float x, y, z, w
using Dictionary = Bytes<8>;
using Array = Bytes<8>;
using PoolVector3Array = Bytes<8>;
using Object = void;

enum VariantType { NIL = 0, BOOL = 1, INT = 2, REAL = 3, STRING = 4, VECTOR3 = 7, QUATERNION = 10, DICTIONARY = 18 };

struct Version {
  unsigned major, minor;
};

// Each list of functions begins so.
struct Head {
  unsigned type;
  Version version;
  const Head* next;
};
struct Core {
  Head head;
  unsigned extension_count;
  const Head** extensions;
  void (*functions[744])();
};
constexpr unsigned CORE = 0, NATIVESCRIPT = 1;  // types
constexpr Version WANTED{1, 0};

struct InitOptions {
  bool is_in_editor;
  std::uint64_t core_hash, editor_hash, no_hash;
  void (*report_version_mismatch)(const Object* library, const char* what, Version wanted, Version found);
  void (*report_loading_error)(const Object* library, const char* what);
  Object* library;
  const Core* core;
  const String* path;
};

// ---- NativeScript 1.0 ----

struct CreateFunction {
  void* (*create)(Object* instance, void* data);
  void* data;
  void (*free)(void* data);
};
struct DestroyFunction {
  void (*destroy)(Object* instance, void* data, void* user);
  void* data;
  void (*free)(void* data);
};
struct MethodAttributes {
  int rpc;
};
struct Method {
  Variant (*call)(Object* instance, void* data, void* user, int count, Variant** arguments);
  void* data;
  void (*free)(void* data);
};
struct NativeScript {
  Head head;
  void (*register_class)(void* handle, const char* name, const char* base, CreateFunction, DestroyFunction);
  void (*register_tool_class)(void* handle, const char* name, const char* base, CreateFunction, DestroyFunction);
  void (*register_method)(void* handle, const char* class_name, const char* name, MethodAttributes, Method);
};

// ---- the functions of the core that are used ----

struct Functions {
  int (*variant_get_type)(const Variant*);
  void (*variant_new_nil)(Variant*);
  void (*variant_new_bool)(Variant*, bool);
  void (*variant_new_int)(Variant*, std::int64_t);
  void (*variant_new_real)(Variant*, double);
  void (*variant_new_string)(Variant*, const String*);
  void (*variant_new_vector3)(Variant*, const Vector3*);
  void (*variant_new_quat)(Variant*, const Quaternion*);
  void (*variant_new_dictionary)(Variant*, const Dictionary*);
  void (*variant_new_array)(Variant*, const Array*);
  void (*variant_new_pool_vector3_array)(Variant*, const PoolVector3Array*);
  std::int64_t (*variant_as_int)(const Variant*);
  double (*variant_as_real)(const Variant*);
  String (*variant_as_string)(const Variant*);
  Vector3 (*variant_as_vector3)(const Variant*);
  Quaternion (*variant_as_quat)(const Variant*);
  Dictionary (*variant_as_dictionary)(const Variant*);
  void (*variant_destroy)(Variant*);
  String (*string_chars_to_utf8)(const char*);  // which makes a string of UTF-8
  CharString (*string_utf8)(const String*);
  void (*string_destroy)(String*);
  const char* (*char_string_get_data)(const CharString*);
  void (*char_string_destroy)(CharString*);
  void (*dictionary_new)(Dictionary*);
  void (*dictionary_set)(Dictionary*, const Variant* key, const Variant* value);
  Variant (*dictionary_get)(const Dictionary*, const Variant* key);
  bool (*dictionary_has)(const Dictionary*, const Variant* key);
  int (*dictionary_size)(const Dictionary*);
  void (*dictionary_destroy)(Dictionary*);
  void (*array_new)(Array*);
  void (*array_append)(Array*, const Variant*);
  void (*array_destroy)(Array*);
  void (*pool_vector3_array_new)(PoolVector3Array*);
  void (*pool_vector3_array_append)(PoolVector3Array*, const Vector3*);
  void (*pool_vector3_array_destroy)(PoolVector3Array*);
  void (*print_error)(const char* description, const char* function, const char* file, int line);
};

inline Functions functions_of(const Core& core) {
  Functions f{};
  const auto take = [&core](auto& function, int position) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(core.functions[position]);
  };
  take(f.variant_get_type, 507);
  take(f.variant_new_nil, 509);
  take(f.variant_new_bool, 510);
  take(f.variant_new_int, 512);
  take(f.variant_new_real, 513);
  take(f.variant_new_string, 514);
  take(f.variant_new_vector3, 517);
  take(f.variant_new_quat, 520);
  take(f.variant_new_dictionary, 528);
  take(f.variant_new_array, 529);
  take(f.variant_new_pool_vector3_array, 535);
  take(f.variant_as_int, 539);
  take(f.variant_as_real, 540);
  take(f.variant_as_string, 541);
  take(f.variant_as_vector3, 544);
  take(f.variant_as_quat, 547);
  take(f.variant_as_dictionary, 555);
  take(f.variant_destroy, 570);
  take(f.char_string_get_data, 572);
  take(f.char_string_destroy, 573);
  take(f.string_utf8, 678);
  take(f.string_chars_to_utf8, 681);
  take(f.string_destroy, 721);
  take(f.dictionary_new, 362);
  take(f.dictionary_destroy, 364);
  take(f.dictionary_size, 365);
  take(f.dictionary_has, 368);
  take(f.dictionary_get, 374);
  take(f.dictionary_set, 375);
  take(f.array_new, 323);
  take(f.array_append, 336);
  take(f.array_destroy, 361);
  take(f.pool_vector3_array_new, 235);
  take(f.pool_vector3_array_append, 238);
  take(f.pool_vector3_array_destroy, 250);
  take(f.print_error, 741);
  return f;
}

}  // namespace godot_api
