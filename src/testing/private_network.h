// Gives a test a network of its own, and thereby LCM's multicast where the machine has none, without root.
#pragma once

#include "base/error.h"

namespace buoyancy::testing {

// Does a message over UDP multicast come back on this machine? It takes a route, which a container or a
// machine without a network may lack.
bool has_multicast();

// Moves this process into a network namespace of its own, whose only interface is the loopback, with a
// multicast route. Processes that it starts from then on are there too; everything else is out of reach:
// the internet, and services on this machine. Sockets that are open stay where they were. Without root, the
// process also gets a user namespace of its own, in which it is root.
//
// Call it at the start of main(): without root the kernel requires that the process has one thread only.
// Errors: more than one thread; a machine that does not permit namespaces, as many containers.
Expected<void> enter_private_network();

// Does nothing if has_multicast(), else enter_private_network().
Expected<void> ensure_multicast();

}  // namespace buoyancy::testing
