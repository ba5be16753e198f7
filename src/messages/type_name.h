// Names the type of a message by its fingerprint, which LCM puts at the beginning of every message.
#pragma once

#include <string>

#include "messages/wire.h"

namespace buoyancy {

// Returns the name of this project's type, or of the type of bot_core that it reads or writes, such as
// "buoyancy.body_states_t" and "bot_core.pose_t"; of another type "0x" and the fingerprint's 16 digits; and
// "no fingerprint" for less than 8 bytes. Says nothing about the rest of the message.
std::string type_name(Bytes message);

}  // namespace buoyancy
