# The clang of Debian 12 or 13, whichever is there: the toolchain of the presets clang and fuzz.
find_program(CMAKE_CXX_COMPILER NAMES clang++-14 clang++-19 REQUIRED)
