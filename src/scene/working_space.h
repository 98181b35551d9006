#pragma once

#include "vdbeam/scene.h"

namespace vdbeam {

/// The scene with every colour in its working space (image.working_space); scene files hold those
/// of Rec.709. Grey stays grey to the last bit, so that the plan holds.
Scene in_working_space(Scene scene);

} // namespace vdbeam
