// SPDX-License-Identifier: MIT
// Every failure of the C++ code becomes wholehand.Error with the line that the program would print, and its exit code.
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "app/program/remedy.h"
#include "app/python/bind.h"
#include "base/system/memory_limit.h"
#include "base/text/error.h"

namespace py = pybind11;

namespace wholehand {
namespace {

void raise(const std::string& line, ExitCode code) {
  std::string shown = line;
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  const py::object type = py::module_::import("wholehand._errors").attr("Error");
  // a path on disk need not be UTF-8
  const auto text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(shown.data(), static_cast<Py_ssize_t>(shown.size()), "backslashreplace"));
  const py::object error = type(text, static_cast<int>(code));
  PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(std::exception_ptr failure) {
  if (!failure) return;
  try {
    std::rethrow_exception(failure);
  } catch (const Error& error) {
    raise(error_line(error), error.code);
  } catch (const py::error_already_set&) {
    throw;  // Python's own
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::bad_alloc&) {
    raise("out of memory" + memory_limit_text() + "; ask for less at once", ExitCode::failure);
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again)
      return raise(std::string("unexpected failure: ") + error.what(), ExitCode::failure);
    raise("no further thread can be started; raise the limits of processes (ulimit -u) and memory (ulimit -v)", ExitCode::failure);
  } catch (const std::exception& error) {
    raise(std::string("unexpected failure: ") + error.what(), ExitCode::failure);
  }
}

}  // namespace

void bind_errors(py::module_& /*module*/) { py::register_local_exception_translator(translate); }

}  // namespace wholehand
