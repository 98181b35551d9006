#include "machine/cgroups.h"

#include "machine/farm_grants.h"
#include "machine/threads.h"
#include "scene/scene_fixture.h"

#include <cstdlib>

namespace vdbeam {
namespace {

/// A folder that looks like the root of a machine.
class Cgroups : public test::SceneTest {
protected:
  void set(const std::string& path, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(file(path)).parent_path());
    write(path, text);
  }
  CgroupLimits limits() const { return cgroup_limits(file("machine")); }
  static constexpr const char* groups = "machine/proc/self/cgroup";
};

TEST_F(Cgroups, NoneMeansNoLimit) {
  EXPECT_EQ(limits().cpus, 0);
  EXPECT_EQ(limits().memory, 0u);
  set(groups, "0::/\nnonsense\n12:pids\n");
  set("machine/sys/fs/cgroup/cpu.max", "max 100000\n");
  set("machine/sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(limits().cpus, 0);
  EXPECT_EQ(limits().memory, 0u);
}

TEST_F(Cgroups, Version2TakesTheLeastOfAllLevels) {
  set(groups, "0::/system.slice/slurmstepd.scope/job_7/step_0\n");
  const std::string top = "machine/sys/fs/cgroup/system.slice";
  set(top + "/cpu.max", "800000 100000\n");
  set(top + "/memory.max", "1000000000\n");
  set(top + "/slurmstepd.scope/job_7/cpu.max", "350000 100000\n");
  set(top + "/slurmstepd.scope/job_7/memory.max", "2000000000\n");
  set(top + "/slurmstepd.scope/job_7/step_0/cpu.max", "max 100000\n");
  set(top + "/slurmstepd.scope/job_7/step_0/memory.max", "max\n");
  EXPECT_EQ(limits().cpus, 4); // three and a half, rounded up
  EXPECT_EQ(limits().memory, 1000000000u);
}

TEST_F(Cgroups, Version1HasAHierarchyForEachController) {
  set(groups, "11:memory:/slurm/uid_5/job_7\n4:cpu,cpuacct:/slurm/uid_5\n3:cpuset:/\n"
              "0::/init.scope\n");
  const std::string top = "machine/sys/fs/cgroup";
  set(top + "/cpu/slurm/uid_5/cpu.cfs_quota_us", "200000\n");
  set(top + "/cpu/slurm/uid_5/cpu.cfs_period_us", "100000\n");
  set(top + "/cpu/cpu.cfs_quota_us", "-1\n");
  set(top + "/cpu/cpu.cfs_period_us", "100000\n");
  set(top + "/memory/slurm/uid_5/job_7/memory.limit_in_bytes", "536870912\n");
  set(top + "/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(limits().cpus, 2);
  EXPECT_EQ(limits().memory, 536870912u);
}

/// Inside a container the groups' own names are those of the host and not there.
TEST_F(Cgroups, AContainerSeesItsOwnLimitAtTheTop) {
  set(groups, "9:memory:/docker/abc\n5:cpu,cpuacct:/docker/abc\n");
  set("machine/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "150000\n");
  set("machine/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  set("machine/sys/fs/cgroup/memory/memory.limit_in_bytes", "4096000\n");
  EXPECT_EQ(limits().cpus, 2);
  EXPECT_EQ(limits().memory, 4096000u);
}

TEST(Threads, FarmGrantsThem) {
  RenderSettings settings;
  setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(thread_count(settings), 1);
  settings.threads = 3;
  EXPECT_EQ(thread_count(settings), 3);
  settings.threads = 0;
  setenv("SLURM_CPUS_PER_TASK", "many", 1);
  setenv("CUE_THREADS", "1", 1);
  EXPECT_EQ(thread_count(settings), 1);
  unsetenv("SLURM_CPUS_PER_TASK");
  unsetenv("CUE_THREADS");
  EXPECT_GE(thread_count(settings), 1);
}

TEST(FarmMemory, IsTheJobsOnThisNode) {
  for (const char* name : {"SLURM_MEM_PER_NODE", "SLURM_MEM_PER_CPU", "SLURM_CPUS_ON_NODE"})
    unsetenv(name);
  EXPECT_EQ(farm_memory(), 0u);
  setenv("SLURM_MEM_PER_CPU", "500", 1);
  EXPECT_EQ(farm_memory(), 0u); // of how many is not known
  setenv("SLURM_CPUS_ON_NODE", "4", 1);
  EXPECT_EQ(farm_memory(), 2000u << 20);
  setenv("SLURM_MEM_PER_NODE", "0", 1); // all that the node has
  EXPECT_EQ(farm_memory(), 2000u << 20);
  setenv("SLURM_MEM_PER_NODE", "lots", 1);
  EXPECT_EQ(farm_memory(), 2000u << 20);
  setenv("SLURM_MEM_PER_NODE", "300", 1);
  EXPECT_EQ(farm_memory(), 300u << 20);
  setenv("SLURM_MEM_PER_NODE", "4294967295", 1);
  EXPECT_GT(farm_memory(), std::uint64_t(1) << 50);
  unsetenv("SLURM_MEM_PER_NODE");
  setenv("SLURM_MEM_PER_CPU", "4294967295", 1);
  setenv("SLURM_CPUS_ON_NODE", "4294967295", 1);
  EXPECT_GT(farm_memory(), std::uint64_t(1) << 50);
}

} // namespace
} // namespace vdbeam
