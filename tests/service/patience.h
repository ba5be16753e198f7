#pragma once

namespace buoyancy {

inline constexpr double kPatience = 60.0;  // s; nothing here takes long, but the machine may be busy

}  // namespace buoyancy
