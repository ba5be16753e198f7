// Does UDP multicast work on this machine? Asked before liblcm is, because liblcm answers a missing route
// with a page on stderr, and packets that do not come back with ten seconds of silence and a later abort.
//
// The probe does what liblcm's own self-test does, with a bound on time: it joins the group, sends one LCM
// message on LCM_SELF_TEST that stays on this machine (ttl 0), and waits until it comes back.
#pragma once

#include "base/error.h"
#include "transport/udpm_url.h"

namespace buoyancy {

inline constexpr int kMulticastProbeMilliseconds = 2000;

// Errors: no route to the group, port taken, packets that do not come back.
Expected<void> probe_multicast(const UdpmUrl& url);

// What is told where the group could not be joined. error: errno.
tl::unexpected<Error> no_multicast_route(const UdpmUrl& url, int error);

}  // namespace buoyancy
