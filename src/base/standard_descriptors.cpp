#include "base/standard_descriptors.h"

#include <fcntl.h>
#include <unistd.h>

namespace buoyancy {

void open_standard_descriptors() {
  int opened = -1;
  do {  // the kernel returns the lowest free number
    opened = ::open("/dev/null", O_RDWR);
    if (opened < 0)
      opened = ::open("/", O_PATH);  // no /dev, as in some chroots: neither readable nor writable
  } while (opened >= 0 && opened <= STDERR_FILENO);
  if (opened >= 0) ::close(opened);
}

}  // namespace buoyancy
