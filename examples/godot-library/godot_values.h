// SPDX-License-Identifier: MIT
// Godot's values from C++ ones and back. Every Variant that is returned belongs to the caller; Value frees its own.
#pragma once

#include <string>

#include "godot_api.h"

namespace godot_values {

using godot_api::Variant;

// Call once, before anything else here.
void use(const godot_api::Functions& functions);

Variant nil();
Variant of(bool value);
Variant of(int value);
Variant of(double value);
Variant of(const std::string& value);  // UTF-8
// Vector3 and Quat are of float32 in Godot: 24 bits are left of a double.
Variant place(const double* xyz);
Variant turn(const double* xyzw);
Variant places(const double (*points)[3], int count);  // PoolVector3Array

// What a caller sent. `is_...` says which type it has; whole numbers count as reals too.
bool is_real(const Variant& variant);
bool is_of(const Variant& variant, godot_api::VariantType type);
double real(const Variant& variant);
std::int64_t whole(const Variant& variant);
std::string text(const Variant& variant);
void place(const Variant& variant, double* xyz);
void turn(const Variant& variant, double* xyzw);

// A Dictionary that is made, key by key. The value is taken over.
class Made {
 public:
  Made();
  ~Made();
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;
  Made& set(const char* key, Variant value);
  Variant take() const;

 private:
  godot_api::Dictionary dictionary_;
};

// An Array that is made.
class Listed {
 public:
  Listed();
  ~Listed();
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;
  void add(Variant value);
  Variant take() const;

 private:
  godot_api::Array array_;
};

// A Dictionary that was sent.
class Sent {
 public:
  explicit Sent(const Variant& variant);
  ~Sent();
  Sent(const Sent&) = delete;
  Sent& operator=(const Sent&) = delete;
  int size() const;
  // Whether it has the key. Sets `number` then; NaN where the value is no number.
  bool number(const char* key, double& number) const;

 private:
  godot_api::Dictionary dictionary_;
};

void print_error(const std::string& line, const char* function);

}  // namespace godot_values
