#include "fmu/model_description.h"

#include <algorithm>
#include <span>

#include "base/format.h"
#include "base/xml_text.h"

namespace buoyancy::fmu {
namespace {

std::string attribute(std::string_view name, std::string_view value) {
  return format_text(" {}=\"{}\"", name, escape_xml(value));
}

std::string_view to_string(Causality causality) {
  constexpr std::array<std::string_view, 4> kNames{"independent", "parameter", "input", "output"};
  return kNames[static_cast<std::size_t>(causality)];
}

std::string_view variability_of(const Variable& variable) {
  if (variable.causality == Causality::kParameter) return "fixed";
  return variable.is_integer() ? "discrete" : "continuous";
}

std::string units_xml() {
  std::string xml = "  <UnitDefinitions>\n";
  for (const Unit& unit : kUnits) {
    xml += "    <Unit" + attribute("name", unit.name) + "><BaseUnit";
    for (const auto& [name, exponent] : {std::pair("kg", unit.kg), std::pair("m", unit.m),
                                         std::pair("s", unit.s), std::pair("rad", unit.rad)}) {
      if (exponent != 0) xml += attribute(name, std::to_string(exponent));
    }
    xml += "/></Unit>\n";
  }
  return xml + "  </UnitDefinitions>\n";
}

std::string numbers_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) {
    if (!text.empty()) text += ' ';
    text += format_shortest(number);
  }
  return text;
}

// Returns the attributes that both versions have; those of the type follow.
std::string common_attributes(const Variable& variable, const std::string& name, std::size_t reference) {
  return attribute("name", name) + attribute("valueReference", std::to_string(reference)) +
         attribute("description", variable.description) +
         attribute("causality", to_string(variable.causality)) +
         attribute("variability", variability_of(variable));
}

// start: of parameters and inputs.
std::string type_attributes(const Variable& variable, std::span<const double> start) {
  return (variable.unit.empty() ? "" : attribute("unit", variable.unit)) +
         (start.empty() ? "" : attribute("start", numbers_text(start)));
}

std::string variable_xml_3(const Variable& variable) {
  const std::string type = variable.is_integer() ? "Int32" : "Float64";
  std::string xml = "    <" + type + common_attributes(variable, variable.name, variable.first) +
                    type_attributes(variable, variable.start);
  if (variable.shape.empty()) return xml + "/>\n";
  xml += ">";
  for (const std::size_t extent : variable.shape) {
    xml += "<Dimension" + attribute("start", std::to_string(extent)) + "/>";
  }
  return xml + "</" + type + ">\n";
}

// Returns "[2]" or "[1,3]", by the structured naming convention; empty for a scalar.
std::string element_index(const Variable& variable, std::size_t element) {
  if (variable.shape.empty()) return {};
  const std::size_t columns = variable.shape.size() == 1 ? 1 : variable.shape[1];
  if (columns == 1) return format_text("[{}]", element + 1);
  return format_text("[{},{}]", element / columns + 1, element % columns + 1);
}

std::string variable_xml_2(const Variable& variable) {
  std::string xml;
  const std::span<const double> start(variable.start);
  for (std::size_t i = 0; i < variable.size; ++i) {
    xml += "    <ScalarVariable" +
           common_attributes(variable, variable.name + element_index(variable, i), variable.first + i) +
           "><" + (variable.is_integer() ? "Integer" : "Real") +
           type_attributes(variable, start.empty() ? start : start.subspan(i, 1)) + "/></ScalarVariable>\n";
  }
  return xml;
}

// Returns the numbers of all variables that an output depends on: value references in FMI 3.0, places in the
// list of scalar variables, from 1 on, in FMI 2.0.
std::string dependencies(const Variable& output, const VariableTable& table, FmiVersion version) {
  std::string text;
  for (const std::size_t index : output.depends_on) {
    const Variable& variable = table.variables()[index];
    const std::size_t count = version == FmiVersion::k2 ? variable.size : 1;
    for (std::size_t i = 0; i < count; ++i) {
      if (!text.empty()) text += ' ';
      text += std::to_string(variable.first + i + (version == FmiVersion::k2 ? 1 : 0));
    }
  }
  return text;
}

std::string structure_xml(const VariableTable& table, FmiVersion version) {
  std::string outputs, unknowns;
  for (const Variable& variable : table.variables()) {
    if (variable.causality != Causality::kOutput) continue;
    const std::string depends = attribute("dependencies", dependencies(variable, table, version));
    if (version == FmiVersion::k3) {
      const std::string reference = attribute("valueReference", std::to_string(variable.first));
      outputs += format_text("    <Output{}{}/>\n", reference, depends);
      unknowns += format_text("    <InitialUnknown{}/>\n", reference);
      continue;
    }
    for (std::size_t i = 0; i < variable.size; ++i) {
      const std::string index = attribute("index", std::to_string(variable.first + i + 1));
      outputs += format_text("      <Unknown{}{}/>\n", index, depends);
      unknowns += format_text("      <Unknown{}/>\n", index);
    }
  }
  if (version == FmiVersion::k2) {
    outputs = "    <Outputs>\n" + outputs + "    </Outputs>\n";
    unknowns = "    <InitialUnknowns>\n" + unknowns + "    </InitialUnknowns>\n";
  }
  return "  <ModelStructure>\n" + outputs + unknowns + "  </ModelStructure>\n";
}

}  // namespace

std::string to_xml(const ModelDescription& model, const VariableTable& table, FmiVersion version) {
  const bool is_2 = version == FmiVersion::k2;
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription" +
                    attribute("fmiVersion", is_2 ? "2.0" : "3.0") + attribute("modelName", model.name) +
                    attribute(is_2 ? "guid" : "instantiationToken", model.token) +
                    attribute("description", "Force and torque of the water on floating bodies") +
                    attribute("generationTool", model.tool) +
                    attribute("variableNamingConvention", "structured") + ">\n";
  xml += "  <CoSimulation" + attribute("modelIdentifier", model.identifier) +
         attribute("canHandleVariableCommunicationStepSize", "true") +
         attribute(is_2 ? "canGetAndSetFMUstate" : "canGetAndSetFMUState", "true") +
         attribute(is_2 ? "canSerializeFMUstate" : "canSerializeFMUState", "true") +
         attribute(is_2 ? "providesDirectionalDerivative" : "providesDirectionalDerivatives",
                   model.has_derivatives ? "true" : "false") +
         (is_2 ? attribute("canNotUseMemoryManagementFunctions", "true") : "") + "/>\n";
  xml += units_xml() + "  <LogCategories>\n";
  for (const std::string_view category : kLogCategories) {
    xml += "    <Category" + attribute("name", category) + "/>\n";
  }
  xml += "  </LogCategories>\n  <DefaultExperiment startTime=\"0\"/>\n  <ModelVariables>\n";
  for (const Variable& variable : table.variables()) {
    xml += is_2 ? variable_xml_2(variable) : variable_xml_3(variable);
  }
  return xml + "  </ModelVariables>\n" + structure_xml(table, version) + "</fmiModelDescription>\n";
}

}  // namespace buoyancy::fmu
