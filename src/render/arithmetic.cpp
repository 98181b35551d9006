#include "render/arithmetic.h"

#include "photonmap/map_queries.h"
#include "scene/content_hash.h"

#include <fmt/format.h>

#include <cmath>

namespace vdbeam {
namespace {

/// Arguments per function: two versions of a function differ in about one result of a hundred.
constexpr int arguments = 4096;

/// Adds f at arguments spread evenly over [first, last].
template <class Float, class Function>
void add_results(Float first, Float last, const Function& f, ContentHash& hash) {
  for (int i = 0; i < arguments; ++i) {
    const Float result =
        f(first + (last - first) * (static_cast<Float>(i) + Float(0.5)) / arguments);
    hash.add(&result, sizeof result);
  }
}

/// The functions that the renderer calls, where it calls them.
template <class Float>
void add_library(ContentHash& hash) {
  add_results<Float>(
      -30, 3, [](Float x) { return std::exp(x); }, hash);
  add_results<Float>(
      -30, 1, [](Float x) { return std::expm1(x); }, hash);
  add_results<Float>(
      -8, 8, [](Float x) { return std::exp2(x); }, hash);
  add_results<Float>(
      0, 1, [](Float x) { return std::log(x); }, hash);
  add_results<Float>(
      0, 16, [](Float x) { return std::log2(x); }, hash);
  add_results<Float>(
      0, 16, [](Float x) { return std::log10(x); }, hash);
  add_results<Float>(
      -1, 4, [](Float x) { return std::log1p(x); }, hash);
  add_results<Float>(
      0, 4, [](Float x) { return std::pow(x, Float(2.4)); }, hash);
  add_results<Float>(
      0, 100, [](Float x) { return std::cbrt(x); }, hash);
  add_results<Float>(
      -7, 7, [](Float x) { return std::sin(x); }, hash);
  add_results<Float>(
      -7, 7, [](Float x) { return std::cos(x); }, hash);
  add_results<Float>(
      -1.5, 1.5, [](Float x) { return std::tan(x); }, hash);
  add_results<Float>(
      -4, 4, [](Float x) { return std::atan(x); }, hash);
  add_results<Float>(
      -4, 4, [](Float x) { return std::atan2(x, Float(0.7)); }, hash);
  add_results<Float>(
      -4, 4, [](Float x) { return std::hypot(x, Float(0.7)); }, hash);
}

} // namespace

std::string arithmetic_fingerprint() {
  ContentHash hash;
  add_library<float>(hash);
  add_library<double>(hash);
  hash.add_number(simd_is_fused());
  return fmt::format("{:016x}", hash.value());
}

} // namespace vdbeam
