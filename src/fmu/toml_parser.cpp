// The parser of toml++, for the FMU alone: elsewhere it is Debian's shared library, which is not part of an
// FMU.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
