// SPDX-License-Identifier: MIT
#include "app/program/remedy.h"

#include "base/system/output.h"
#include "base/text/printable.h"
#include "core/domain.h"

namespace wholehand {

const char* remedy_words(Remedy remedy) {
  switch (remedy) {
    case Remedy::core:
      return "; use --on core";
    case Remedy::or_core:
      return ", or use --on core";
    case Remedy::double_precision:
      return "; use --precision double";
    case Remedy::float_precision:
      return "; use --precision float";
    case Remedy::or_float_precision:
      return ", or use --precision float";
    case Remedy::name_library:
      return " (--dhd-library, [device] library of the scene, or the environment variable WHOLEHAND_DHD_LIBRARY)";
    case Remedy::none:
      break;
  }
  return "";
}

std::string error_line(const Error& error) { return one_line(std::string(error.what()) + remedy_words(error.remedy)); }

std::vector<std::string> print_float_warnings(const Scene& scene, Precision precision) {
  std::vector<std::string> lines = domain_warnings(scene, precision);
  for (std::string& line : lines) {
    line += remedy_words(Remedy::double_precision);
    print_note(line);
  }
  return lines;
}

}  // namespace wholehand
