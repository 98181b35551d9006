#include "vdb/brick_builder.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace vdbeam {
namespace {

/// A dense cube of smooth values, 8 * width voxels across.
struct Cube {
  explicit Cube(int width) {
    for (int i = 0; i < width; ++i)
      for (int j = 0; j < width; ++j)
        for (int k = 0; k < width; ++k) {
          for (const int cell : {i, j, k})
            origins.push_back(leaf_width * cell);
          for (int v = 0; v < leaf_size; ++v)
            values.push_back(1 + 0.5f * std::sin(0.1f * static_cast<float>(v + 7 * i + 5 * j + k)));
        }
  }
  DensityField build() {
    RawGrid grid;
    grid.leaf_count = origins.size() / 3;
    grid.leaf_origins = origins.data();
    grid.leaf_values = values.data();
    return build_bricks(grid, "cube", std::uint64_t(1) << 34).field;
  }
  std::vector<std::int32_t> origins;
  std::vector<float> values;
};

/// Trilinear samples along oblique lines through a 256^3 volume; the argument is the step in
/// voxels.
void sample_along_lines(benchmark::State& state) {
  const DensityField field = Cube(32).build();
  const auto step = static_cast<float>(state.range(0));
  const Vec3f direction = Vec3f(0.80f, 0.48f, 0.36f) * step;
  std::int64_t samples = 0;
  float start = 0;
  for (auto _ : state) {
    start = std::fmod(start + 37.3f, 200.0f);
    Vec3f at{10, 20 + 0.4f * start, 10 + 0.7f * start};
    float sum = 0;
    for (; at.x < 250 && at.y < 250 && at.z < 250; at += direction, ++samples)
      sum += field.sample(at);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(samples);
}
BENCHMARK(sample_along_lines)->Arg(1)->Arg(4);

void build_256_cubed(benchmark::State& state) {
  Cube cube(32);
  for (auto _ : state)
    benchmark::DoNotOptimize(cube.build());
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(cube.values.size() * sizeof(float)));
}
BENCHMARK(build_256_cubed)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace vdbeam
