// Infers from what the service says about itself, or does not say, why it differs or does not respond.
#pragma once

#include <string>
#include <vector>

#include "client/ping/service_link.h"
#include "scene/scene.h"

namespace buoyancy::ping {

// Returns how the service's description of itself differs from the scene here: bodies, fingerprint, version,
// conditions, sea, several services on one channel.
std::vector<std::string> causes_from_service(const Scene& scene, const ServiceInfo& service);

// Warns of what a user has to know about the service even if all values agree: another scene, other services,
// states that contradict themselves.
std::vector<Warning> service_warnings(const Scene& scene, const ServiceInfo& service);

// Returns why there was no response at all.
std::string cause_of_silence(const LinkOptions& options, const std::string& url, const ServiceInfo& service);

}  // namespace buoyancy::ping
