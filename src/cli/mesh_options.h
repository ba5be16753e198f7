// The options that place the mesh of --mesh, shared by the programs that have it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <CLI/App.hpp>

#include "base/error.h"
#include "scene/mesh_placement.h"

namespace buoyancy {

// Declare --scale FACTOR|X,Y,Z and --up AXIS on app; parsing fills the text, which must live as long, for
// parse_scale() and placement_of(). scale: the default. mesh: the option --mesh, which they need;
// nullptr: a program without one.
void add_scale_option(CLI::App& app, std::string& scale, CLI::Option* mesh);
void add_up_option(CLI::App& app, std::optional<std::string>& up, CLI::Option* mesh);

// Parses the text of --scale. Errors: it is neither a finite number above 0 nor three finite factors X,Y,Z of
// which none is 0.
Expected<Vec3> parse_scale(const std::string& text);

// Returns the unit vector of x, +x, -x and so on. subject: the option, for errors. Errors: any other text.
Expected<Vec3> parse_axis(const std::string& subject, const std::string& text);

// Parses three finite numbers X,Y,Z.
std::optional<Vec3> parse_vector(std::string_view text);

// Returns the placement by --scale and --up: the file's axis of --up becomes +z, unless it is nullopt.
// Errors: those of parse_scale() and parse_axis().
Expected<MeshPlacement> placement_of(const std::string& scale, const std::optional<std::string>& up);

}  // namespace buoyancy
