// Keeps descriptors 0 to 2 from naming files that a program opens.
#pragma once

namespace buoyancy {

// Opens /dev/null as each of the descriptors 0 to 2 that is closed. Otherwise the next file that the program
// opens would get that number, and what the program prints would be written into it. Call this function
// before the program opens anything.
void open_standard_descriptors();

}  // namespace buoyancy
