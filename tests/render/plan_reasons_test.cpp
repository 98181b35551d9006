#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>
#include <set>

namespace vdbeam {
namespace {

TEST(PlanReasons, EveryStageHasOneOfItsOwn) {
  for (const char* estimator : {"beam", "march", "path"}) {
    const RenderPlan plan =
        make_plan(load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1,
                             {std::string("render.estimator=") + estimator,
                              "volume.0.phase={type=\"henyey_greenstein\", g=0.5}"}));
    std::set<std::string> reasons;
    for (const PlanStage& stage : plan.stages) {
      EXPECT_FALSE(stage.reason.empty()) << stage_name(stage.stage);
      if (stage.needed) {
        EXPECT_TRUE(reasons.insert(stage.reason).second) << stage.reason;
      }
    }
  }
}

} // namespace
} // namespace vdbeam
