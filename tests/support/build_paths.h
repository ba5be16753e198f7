// Where a test finds the files of the source tree and the programs of its build. Only build_paths.cpp is
// compiled with these directories: all other objects are then the same in a clone elsewhere, so that ccache
// finds them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace buoyancy {

std::filesystem::path source_dir();

// The path of a program of this build, such as "buoyancyd". The test's target depends on the program's.
std::string built_program(std::string_view name);

// For screenshots of browser tests; not created.
std::filesystem::path pictures_dir();

}  // namespace buoyancy
