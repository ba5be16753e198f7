#include "base/error.h"

namespace buoyancy {

std::string Error::message() const {
  std::string line = subject + ": " + found + "; expected " + expectation + ".";
  if (!cause.empty()) line += " Likely cause: " + cause + ".";
  if (!remedy.empty()) line += " " + remedy + ".";
  return line;
}

}  // namespace buoyancy
