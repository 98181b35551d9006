#pragma once

#include <cstdint>

namespace vdbeam {

/// Bijective mix of 64 bits (Steele, Lea, Flood 2014, SplitMix64's finaliser).
constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// Purpose of a random stream; two stages never share numbers.
enum class RngStage : std::uint64_t {
  camera = 1,
  photon,
  path,
  direct,
  march,
  light,
  test,
  walk,
  split,
  surface,
  line,
  final_gather,
  shaft_light,
  more_surface
};

/// Everything that identifies a stream, except the index within its stage.
struct RngKey {
  std::uint64_t seed = 1;
  std::uint64_t frame = 0;
  std::uint64_t pass = 0;

  bool operator==(const RngKey&) const = default;
};

/// A counter-based generator: the n-th number of a stream is a pure function of the stream's
/// identity (seed, frame, pass, stage, index) and n, not of a thread. Numbers: Squares (Widynski
/// 2020, arXiv:2004.06278), four rounds, 32 bits.
class Rng {
public:
  Rng(const RngKey& key, RngStage stage, std::uint64_t index) {
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ull;
    std::uint64_t h = mix64(key.seed + golden);
    h = mix64(h ^ (key.frame + 2 * golden));
    h = mix64(h ^ (key.pass + 3 * golden));
    h = mix64(h ^ (static_cast<std::uint64_t>(stage) + 4 * golden));
    key_ = mix64(h ^ (index + 5 * golden)) | 1;
  }

  std::uint32_t bits() {
    std::uint64_t x = counter_++ * key_;
    const std::uint64_t y = x;
    const std::uint64_t z = y + key_;
    x = x * x + y;
    x = (x >> 32) | (x << 32);
    x = x * x + z;
    x = (x >> 32) | (x << 32);
    x = x * x + y;
    x = (x >> 32) | (x << 32);
    return static_cast<std::uint32_t>((x * x + z) >> 32);
  }

  /// Uniform in [0, 1), 24 bits.
  float uniform() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
  /// Uniform in (0, 1], 32 bits towards zero: fit for a logarithm.
  float uniform_positive() { return (static_cast<float>(bits()) + 0.5f) * 0x1p-32f; }

private:
  std::uint64_t key_;
  std::uint64_t counter_ = 1;
};

} // namespace vdbeam
