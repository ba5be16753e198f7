// The header is C99 by itself, under the strictest warnings.
#include <buoyancy/buoyancy.h>

// A translation unit of C is not empty.
int buoyancy_header_is_c99(void);
int buoyancy_header_is_c99(void) {
  return BUOYANCY_OK;
}
