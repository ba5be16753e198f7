// Keeps descriptors 0 to 2 from naming files that a program opens.
#pragma once

namespace buoyancy {

// Opens /dev/null as each of the descriptors 0 to 2 that is closed: the next file that a program opens would
// get its number, and what the program prints would be written into that file. Call it before the program
// opens anything.
void open_standard_descriptors();

}  // namespace buoyancy
