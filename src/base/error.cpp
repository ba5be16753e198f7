#include "base/error.h"

namespace buoyancy {

std::string Error::message() const {
  std::string line = subject + ": " + actual + "; expected " + expected + ".";
  if (!cause.empty()) line += " Likely cause: " + cause + ".";
  if (!hint.empty()) line += " " + hint + ".";
  return line;
}

}  // namespace buoyancy
