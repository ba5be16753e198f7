// Reads panel meshes of wave-load programs: WAMIT's .gdf and Nemoh's .dat.
//
// Source of the formats: WAMIT User Manual, chapter 6 (low-order method); the Nemoh manual, section on mesh
// files. Panels have four corners, counter-clockwise seen from the water; a triangle has two equal ones.
#pragma once

#include "base/error.h"
#include "geometry/import_channel.h"

namespace buoyancy {

bool is_panel_format(MeshFormat format);

// Reads request.name of one of these formats. Panels become polygons; their mirror images in the planes of
// symmetry are added. Coordinates are read as doubles; those in feet (a WAMIT file whose GRAV is 32.174)
// become metres. The caller sets Error::subject.
Expected<StoredMesh> read_panels(const ImportRequest& request, const OpenFile& open);

}  // namespace buoyancy
