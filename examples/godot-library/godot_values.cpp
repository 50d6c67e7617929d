// SPDX-License-Identifier: MIT
#include "godot_values.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace godot_values {

using namespace godot_api;

namespace {

Functions api;

// The floats of Vector3 and Quat.
template <class To>
To floats(const double* from) {
  constexpr int count = sizeof(To) / sizeof(float);
  float numbers[count];
  for (int k = 0; k < count; ++k) numbers[k] = static_cast<float>(from[k]);
  To to;
  std::memcpy(&to, numbers, sizeof to);
  return to;
}

template <class From>
void doubles(const From& from, double* to) {
  constexpr int count = sizeof(From) / sizeof(float);
  float numbers[count];
  std::memcpy(numbers, &from, sizeof from);
  for (int k = 0; k < count; ++k) to[k] = numbers[k];
}

}  // namespace

void use(const Functions& functions) { api = functions; }

Variant nil() {
  Variant made;
  api.variant_new_nil(&made);
  return made;
}

Variant of(bool value) {
  Variant made;
  api.variant_new_bool(&made, value);
  return made;
}

Variant of(int value) {
  Variant made;
  api.variant_new_int(&made, value);
  return made;
}

Variant of(double value) {
  Variant made;
  api.variant_new_real(&made, value);
  return made;
}

Variant of(const std::string& value) {
  String string = api.string_chars_to_utf8(value.c_str());
  Variant made;
  api.variant_new_string(&made, &string);
  api.string_destroy(&string);
  return made;
}

Variant place(const double* xyz) {
  const Vector3 vector = floats<Vector3>(xyz);
  Variant made;
  api.variant_new_vector3(&made, &vector);
  return made;
}

Variant turn(const double* xyzw) {
  const Quaternion quaternion = floats<Quaternion>(xyzw);
  Variant made;
  api.variant_new_quat(&made, &quaternion);
  return made;
}

Variant places(const double (*points)[3], int count) {
  PoolVector3Array array;
  api.pool_vector3_array_new(&array);
  for (int k = 0; k < count; ++k) {
    const Vector3 vector = floats<Vector3>(points[k]);
    api.pool_vector3_array_append(&array, &vector);
  }
  Variant made;
  api.variant_new_pool_vector3_array(&made, &array);
  api.pool_vector3_array_destroy(&array);
  return made;
}

bool is_of(const Variant& variant, VariantType type) { return api.variant_get_type(&variant) == type; }
bool is_real(const Variant& variant) { return is_of(variant, REAL) || is_of(variant, INT); }
double real(const Variant& variant) { return api.variant_as_real(&variant); }
std::int64_t whole(const Variant& variant) { return api.variant_as_int(&variant); }
void place(const Variant& variant, double* xyz) { doubles(api.variant_as_vector3(&variant), xyz); }
void turn(const Variant& variant, double* xyzw) { doubles(api.variant_as_quat(&variant), xyzw); }

std::string text(const Variant& variant) {
  String string = api.variant_as_string(&variant);
  CharString utf8 = api.string_utf8(&string);
  const char* characters = api.char_string_get_data(&utf8);
  const std::string own = characters ? characters : "";
  api.char_string_destroy(&utf8);
  api.string_destroy(&string);
  return own;
}

Made::Made() { api.dictionary_new(&dictionary_); }
Made::~Made() { api.dictionary_destroy(&dictionary_); }

Made& Made::set(const char* key, Variant value) {
  Variant name = of(std::string(key));
  api.dictionary_set(&dictionary_, &name, &value);
  api.variant_destroy(&name);
  api.variant_destroy(&value);
  return *this;
}

Variant Made::take() const {
  Variant made;
  api.variant_new_dictionary(&made, &dictionary_);
  return made;
}

Listed::Listed() { api.array_new(&array_); }
Listed::~Listed() { api.array_destroy(&array_); }

void Listed::add(Variant value) {
  api.array_append(&array_, &value);
  api.variant_destroy(&value);
}

Variant Listed::take() const {
  Variant made;
  api.variant_new_array(&made, &array_);
  return made;
}

Sent::Sent(const Variant& variant) : dictionary_(api.variant_as_dictionary(&variant)) {}
Sent::~Sent() { api.dictionary_destroy(&dictionary_); }
int Sent::size() const { return api.dictionary_size(&dictionary_); }

bool Sent::number(const char* key, double& number) const {
  Variant name = of(std::string(key));
  const bool has = api.dictionary_has(&dictionary_, &name);
  if (has) {
    Variant value = api.dictionary_get(&dictionary_, &name);
    number = is_real(value) ? real(value) : std::numeric_limits<double>::quiet_NaN();
    api.variant_destroy(&value);
  }
  api.variant_destroy(&name);
  return has;
}

void print_error(const std::string& line, const char* function) { api.print_error(line.c_str(), function, "", 0); }

}  // namespace godot_values
