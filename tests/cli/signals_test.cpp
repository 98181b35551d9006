#include "cli_fixture.h"

namespace vdbeam {
namespace {

using test::CliTest;

/// A queue signals the script of a job and its children, and the script passes the signal on.
TEST_F(CliTest, SameSignalFromTwoSidesIsOne) {
  const pid_t child = start({"render", cloud, "--resolution", "32x18", "--set",
                             "render.photons=2000", "--passes", "1000000", "-o", "a.exr"});
  wait_for_output(child);
  kill(child, SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGTERM);
  const auto result = finish(child);
  EXPECT_FALSE(result.killed);
  EXPECT_EQ(result.code, 143);
}

} // namespace
} // namespace vdbeam
