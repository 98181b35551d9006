#pragma once

#include "camera/camera.h"
#include "transport/world.h"
#include "vdbeam/image.h"
#include "vdbeam/picture_facts.h"
#include "vdbeam/pixel_region.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Objects that a grid of camera rays meets.
struct Sight {
  double optical_depth = 0; ///< of the deepest ray, in the channel with most
  int rays = 0;
  int blocked = 0;         ///< rays that a surface ends before any medium
  int inside = 0;          ///< rays that meet the back of a surface first
  int surface = -1;        ///< the surface that ends them all, or -1
  double nearest = 0;      ///< of the surfaces' hits [world]; 0: there is none
  double medium_begin = 0; ///< the nearest distance at which a ray enters the medium's bounds if
                           ///< nothing is in the way [world]; 0: none does
};

/// Sends rays through the window (pixels counted from the corner of the overscan).
Sight look_through(const World& world, const Camera& camera, const PixelRegion& window);

/// Notes about obstacles between camera and medium: a surface around it or before it, camera.far,
/// or an extinction too small to be seen. Nothing where it is seen.
std::vector<std::string> sight_notes(const Scene& scene, const World& world, const Camera& camera,
                                     const Sight& sight);

/// The facts of a finished picture.
PictureFacts picture_facts(const Image& image, const Sight& sight);

/// Notes about an obviously wrong image: all is black, or most of it above 1.
std::vector<std::string> picture_notes(const PictureFacts& facts);

} // namespace vdbeam
