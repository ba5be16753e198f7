// Checks that UDP multicast works on this machine, before liblcm is used: liblcm prints a page on standard
// error if there is no route, and if packets are not looped back it blocks for ten seconds and aborts later.
//
// The probe does what liblcm's own self-test does, with a time limit: it joins the group, sends one LCM
// message on LCM_SELF_TEST that stays on this machine (ttl 0), and waits until it is looped back.
#pragma once

#include "base/error.h"
#include "transport/udpm_url.h"

namespace buoyancy {

inline constexpr int kMulticastProbeMilliseconds = 2000;

// Errors: no route to the group, port in use, packets that are not looped back.
Expected<void> probe_multicast(const UdpmUrl& url);

// The error for a group that could not be joined. error: errno.
tl::unexpected<Error> no_multicast_route(const UdpmUrl& url, int error);

}  // namespace buoyancy
