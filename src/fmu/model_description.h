// Writes modelDescription.xml, which tells a host what an FMU has, in both versions of the standard.
#pragma once

#include <string>

#include "fmu/variables.h"

namespace buoyancy::fmu {

struct ModelDescription {
  std::string name;        // of the scene
  std::string identifier;  // of the model: names the shared library
  std::string token;       // guid in FMI 2.0, instantiationToken in FMI 3.0
  std::string tool;        // "buoyancy-fmu 1.0.0"
  bool has_derivatives = false;
};

// Returns the file with all variables of the table.
std::string to_xml(const ModelDescription& model, const VariableTable& table, FmiVersion version);

}  // namespace buoyancy::fmu
