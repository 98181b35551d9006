#include "materials/diffuse.h"

namespace vdbeam {

std::unique_ptr<Material> make_diffuse(const MaterialSettings& settings, double) {
  return std::make_unique<Diffuse>(settings);
}

} // namespace vdbeam
