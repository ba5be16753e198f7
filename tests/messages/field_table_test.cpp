// Compares the tables of wire_layout.h with the message definitions, with the interfaces of other languages
// and with the documentation, which all list the same fields.

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "base/text_file.h"
#include "messages/body_csv.h"
#include "tests/support/build_paths.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

struct TableRow {
  std::string name, unit, type;
  std::vector<std::size_t> shape;

  std::size_t count() const {
    std::size_t product = 1;
    for (const std::size_t size : shape) product *= size;
    return product;
  }
};

template <typename Member>
struct TypeOf {
  static void describe(TableRow& row) {
    if constexpr (std::is_same_v<Member, double>) row.type = "double";
    if constexpr (std::is_same_v<Member, std::string>) row.type = "string";
    if constexpr (std::is_same_v<Member, std::int64_t>) row.type = "int64_t";
    if constexpr (std::is_same_v<Member, std::int32_t> || std::is_enum_v<Member>) row.type = "int32_t";
  }
};
template <typename Element, std::size_t kSize>
struct TypeOf<std::array<Element, kSize>> {
  static void describe(TableRow& row) {
    row.shape.push_back(kSize);
    TypeOf<Element>::describe(row);
  }
};

template <typename Message>
std::vector<TableRow> table_of() {
  std::vector<TableRow> rows;
  const Message message;
  visit_named_fields(message, [&rows]<typename Member>(const Field& field, const Member& /*member*/) {
    TableRow& row = rows.emplace_back();
    row.name = field.name;
    row.unit = field.unit;
    TypeOf<Member>::describe(row);
  });
  return rows;
}

std::string text_of(const std::string& path) {
  constexpr std::uintmax_t kMaxBytes = 10'000'000;
  const auto text = read_text_file(source_dir() / path, path, kMaxBytes);
  EXPECT_TRUE(text.has_value()) << path;
  return text.value_or("");
}

// What lies between two texts; the whole rest if the second does not follow.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  EXPECT_NE(from, std::string::npos) << begin;
  if (from == std::string::npos) return "";
  const std::size_t start = from + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

struct Declaration {
  std::string type, name, dimensions, comment;
};

// The members of a struct of C or LCM, with their comments, which may go on below them.
std::vector<Declaration> declarations(const std::string& text) {
  static const std::regex kMember(R"(\s*(?:const )?(\w+)\*? +(\w+)((?:\[\d+\])*);\s*(?:// ?(.*))?)");
  static const std::regex kComment(R"(\s+// ?(.*))");
  std::vector<Declaration> found;
  std::istringstream lines(text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, kMember)) {
      found.push_back({match[1], match[2], match[3], match[4]});
    } else if (!found.empty() && std::regex_match(line, match, kComment)) {
      found.back().comment += " " + match[1].str();
    }
  }
  return found;
}

void expect_unit(const TableRow& row, const std::string& comment) {
  if (row.unit.empty()) return;
  EXPECT_TRUE(contains(comment, "[" + row.unit + "]")) << row.name;
}

template <typename Message>
void expect_defined_as(const std::string& type) {
  const std::string text = text_of("lcmtypes/" + type + ".lcm");
  const std::vector<Declaration> defined = declarations(between(text, "struct " + type, "\n}"));
  const std::vector<TableRow> table = table_of<Message>();
  ASSERT_EQ(defined.size(), table.size()) << type;
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::string dimensions;
    for (const std::size_t size : table[i].shape) dimensions += "[" + std::to_string(size) + "]";
    EXPECT_EQ(table[i].name, defined[i].name) << type;
    EXPECT_EQ(table[i].type, defined[i].type) << table[i].name;
    EXPECT_EQ(dimensions, defined[i].dimensions) << table[i].name;
    expect_unit(table[i], defined[i].comment);
  }
}

TEST(FieldTable, EqualsTheMessageDefinitions) {
  expect_defined_as<BodyState>("body_state_t");
  expect_defined_as<BodyWrench>("body_wrench_t");
  expect_defined_as<BodyHydrostatics>("body_hydrostatics_t");
  expect_defined_as<BodyLoads>("body_loads_t");
  expect_defined_as<ServiceStatus>("service_status_t");
}

// The name of a field in the interfaces that hold an array of it.
std::string plural_of(const std::string& name) {
  static const std::map<std::string, std::string> kIrregular{{"added_mass", "added_masses"},
                                                             {"center_of_buoyancy", "centers_of_buoyancy"},
                                                             {"metacentric_radii", "metacentric_radii"},
                                                             {"quaternion_wxyz", "quaternions"},
                                                             {"status", "statuses"},
                                                             {"stiffness", "stiffnesses"},
                                                             {"submerged_volume", "volumes"}};
  if (const auto found = kIrregular.find(name); found != kIrregular.end()) return found->second;
  if (name.ends_with("s")) return name;
  return name.ends_with("y") ? name.substr(0, name.size() - 1) + "ies" : name + "s";
}

// "3 n" where each of n poses has three numbers.
void expect_count(const TableRow& row, const std::string& comment) {
  const std::string count = row.count() == 1 ? "n" : std::to_string(row.count()) + " n";
  EXPECT_TRUE(std::regex_search(comment, std::regex("(^|; )" + count + "\\b")))
      << row.name << ": " << comment;
}

// The fields of a table that a struct of arrays has: all but the id, and without the status where it has
// none.
std::vector<TableRow> array_fields(std::vector<TableRow> table, bool with_status) {
  std::erase_if(table, [with_status](const TableRow& row) {
    return row.name == "body_id" || (row.name == "status" && !with_status);
  });
  return table;
}

// first: where the arrays begin among the members.
void expect_arrays(const std::string& name, std::size_t first, const std::vector<TableRow>& fields) {
  const std::string header = text_of("src/c/buoyancy.h");
  const std::vector<Declaration> members =
      declarations(between(header, "typedef struct " + name + " {\n", "\n}"));
  ASSERT_GE(members.size(), first + fields.size()) << name;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Declaration& member = members[first + i];
    EXPECT_EQ(member.name, plural_of(fields[i].name)) << name;
    EXPECT_EQ(member.type, fields[i].type) << member.name;
    expect_unit(fields[i], member.comment);
    expect_count(fields[i], member.comment);
  }
}

TEST(FieldTable, EqualsTheArraysOfTheCHeader) {
  expect_arrays("buoyancy_poses", 2, array_fields(table_of<BodyState>(), false));
  expect_arrays("buoyancy_wrenches", 1, array_fields(table_of<BodyWrench>(), true));
  expect_arrays("buoyancy_hydrostatics", 1, array_fields(table_of<BodyHydrostatics>(), true));
  expect_arrays("buoyancy_loads", 1, array_fields(table_of<BodyLoads>(), false));
}

// "forceErrorBounds", or "ForceErrorBounds" with upper.
std::string camel_case(const std::string& name, bool upper) {
  std::string text;
  for (const char c : name) {
    if (c == '_') {
      upper = true;
      continue;
    }
    text += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = false;
  }
  return text;
}

void expect_csharp_class(const std::string& name, const std::vector<TableRow>& fields) {
  const std::string text = text_of("client/examples/csharp/Buoyancy.cs");
  const std::string of_class = between(text, "public sealed class " + name + "\n", "\n    }");
  const std::string of_struct = between(text, "internal struct " + name + "\n", "}");
  std::string pointers;
  for (const TableRow& field : fields) {
    const std::string plural = plural_of(field.name);
    pointers += (pointers.empty() ? "public IntPtr " : ", ") + camel_case(plural, false);
    const std::string numbers = field.type == "double" ? "double" : "int";
    const std::regex member("<summary>(.*)</summary>\\s*public " + numbers + "\\[\\] " +
                            camel_case(plural, true) + ";");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(of_class, match, member)) << name << "." << camel_case(plural, true);
    expect_unit(field, match[1]);
    expect_count(field, match[1]);
  }
  EXPECT_TRUE(contains(of_struct, pointers));
}

TEST(FieldTable, EqualsTheArraysOfCSharp) {
  expect_csharp_class("Poses", array_fields(table_of<BodyState>(), false));
  expect_csharp_class("Wrenches", array_fields(table_of<BodyWrench>(), true));
}

// length: the letter for the number of rows. single: properties of one pose are numbers.
void expect_python_class(const std::string& name, char length, bool single,
                         const std::vector<TableRow>& fields) {
  const std::string text = text_of("src/python/buoyancy/__init__.pyi");
  const std::string of_class = between(text, "\nclass " + name + ":\n", "\nclass ");
  for (const TableRow& field : fields) {
    std::string property = field.name == "submerged_volume" ? "volume" : field.name;
    if (property == "quaternion_wxyz") property = "quaternion";
    const bool is_status = field.name == "status";
    std::string type = is_status ? "IntArray" : "Array";
    if (single && field.shape.empty()) type = "Union[" + type + (is_status ? ", Status]" : ", float]");
    const std::string declaration = "    " + property + ": Final[" + type + "]  # (" + length;
    ASSERT_TRUE(contains(of_class, declaration)) << name;
    const std::string comment = between(of_class, declaration, "\n");
    std::string shape = field.shape.empty() ? ",)" : "";
    for (const std::size_t size : field.shape) shape += ", " + std::to_string(size);
    if (!field.shape.empty()) shape += ")";
    EXPECT_TRUE(comment.starts_with(shape)) << name << "." << property << ": " << comment;
    if (field.unit.empty()) continue;
    EXPECT_TRUE(contains(comment, ", " + field.unit)) << name << "." << property;
  }
}

TEST(FieldTable, EqualsThePythonStub) {
  expect_python_class("Wrenches", 'K', true, array_fields(table_of<BodyWrench>(), true));
  expect_python_class("Hydrostatics", 'K', true, array_fields(table_of<BodyHydrostatics>(), true));
  expect_python_class("Loads", 'K', true, array_fields(table_of<BodyLoads>(), false));
  expect_python_class("RecordedStates", 'N', false, array_fields(table_of<BodyState>(), false));
  expect_python_class("RecordedWrenches", 'N', false, array_fields(table_of<BodyWrench>(), true));
}

// "m³" of "m^3".
std::string printed(const std::string& unit) {
  std::string text = unit;
  for (const auto& [ascii, sign] :
       std::map<std::string, std::string>{{"^2", "²"}, {"^3", "³"}, {"^4", "⁴"}, {"us", "µs"}}) {
    const std::size_t at = text.find(ascii);
    if (at != std::string::npos) text.replace(at, ascii.size(), sign);
  }
  return text;
}

template <typename Message>
void expect_documented(const std::string& type) {
  const std::string section = between(text_of("docs/messages.md"), ": `" + type + "`\n", "\n## ");
  for (const TableRow& field : table_of<Message>()) {
    const std::string key = "`" + field.name + "`";
    std::istringstream lines(section);
    std::string line;
    while (std::getline(lines, line)) {
      if (line.starts_with("| `") && line.find(key) < line.find(" |", 1)) break;
    }
    ASSERT_TRUE(contains(line, key)) << type;
    std::istringstream units(printed(field.unit));
    for (std::string unit; std::getline(units >> std::ws, unit, ',');) {
      EXPECT_TRUE(std::regex_search(line, std::regex("[ (]" + unit + "[ ,:;.]"))) << unit << " in " << line;
    }
  }
}

TEST(FieldTable, IsDocumentedWithItsUnits) {
  expect_documented<BodyState>("body_states_t");
  expect_documented<BodyWrench>("body_wrenches_t");
  expect_documented<BodyHydrostatics>("bodies_hydrostatics_t");
  expect_documented<BodyLoads>("bodies_loads_t");
  expect_documented<ServiceStatus>("service_status_t");
}

template <typename Body>
void expect_column_for_every_number() {
  const std::string header = csv_header<Body>();
  std::string row;
  append_csv_row(0, Body{}, row);
  EXPECT_EQ(std::ranges::count(header, ','), std::ranges::count(row, ',')) << header;
}

TEST(BodyCsv, NamesEveryColumn) {
  expect_column_for_every_number<BodyState>();
  expect_column_for_every_number<BodyWrench>();
  expect_column_for_every_number<BodyLoads>();
}

TEST(BodyCsv, WritesTheColumnsThatTheDocsState) {
  const std::string states = csv_header<BodyState>();
  const std::string replay = text_of("docs/replay.md");
  EXPECT_TRUE(contains(replay, "`" + csv_header<BodyState>({"body_id", "quaternion_wxyz"}) + "`"));
  EXPECT_TRUE(contains(replay, "\n    " + csv_header<BodyWrench>() + "\n"));
  EXPECT_TRUE(contains(
      text_of("docs/runs.md"),
      "\n    " + states + "," + csv_columns<BodyWrench>({"status", "center_of_buoyancy"}) + ",energy\n"));
}

TEST(BodyCsv, WritesMatricesAfterAllOtherFields) {
  const std::string header = csv_header<BodyLoads>();
  EXPECT_TRUE(header.starts_with("utime,body_id,status,immersion,buoyancy_fx,")) << header;
  EXPECT_TRUE(contains(header, ",added_mass_tz,water_vx,water_vy,water_vz,added_mass_11,added_mass_12,"));
  EXPECT_TRUE(header.ends_with(",damping_65,damping_66")) << header;
}

}  // namespace
}  // namespace buoyancy
