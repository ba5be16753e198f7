#include "flotation/displaced_parts.h"

#include "flotation/displaced_sum.h"

namespace buoyancy {

std::vector<DisplacedPart> displaced_parts(const FloatingBody& body, const Pose& pose, const Water& water) {
  const WaterPlane plane = water_plane_in_body(pose, water, body.center_B());
  const Water unlayered{.up_W = water.up_W, .level = water.level, .density = water.density};
  std::vector<DisplacedPart> parts;
  for (const FloatingBody::SignedVolume& volume : body.volumes()) {
    const DisplacedSum displaced = displaced_by(volume, plane, water);
    const bool displaces = displaced.volume != 0.0;
    parts.push_back(
        {water.layers.empty() ? displaced.volume : displaced_by(volume, plane, unlayered).volume,
         water.density * displaced.volume,
         displaces ? Vec3(body.center_B() + displaced.moment / displaced.volume) : Vec3::Constant(kNaN)});
  }
  return parts;
}

}  // namespace buoyancy
