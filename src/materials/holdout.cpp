#include "materials/black.h"

namespace vdbeam {
namespace {

/// Stands for an object that is composited later: black and without alpha to the camera, it hides
/// what is behind it and casts its shadow.
class Holdout final : public BlackMaterial {
public:
  Holdout() : BlackMaterial(MaterialType::holdout) {}
  bool is_holdout() const override { return true; }
};

} // namespace

std::unique_ptr<Material> make_holdout(const MaterialSettings&, double) {
  return std::make_unique<Holdout>();
}

} // namespace vdbeam
