#include "estimators/beam/deep_tile.h"

#include "layers/ray_sink.h"

#include <algorithm>

namespace vdbeam {
namespace {

/// The part of a knot's hat, which reaches one knot to either side, before the distance x from it,
/// in knots.
float hat_before(float x) {
  if (x <= -1)
    return 0;
  if (x >= 1)
    return 1;
  return x < 0 ? 0.5f * (1 + x) * (1 + x) : 1 - 0.5f * (1 - x) * (1 - x);
}

/// A pixel's ray, with the edges of its pieces in knots of its sub-tile's table.
struct CutRay {
  RaySink sink;
  double shift = 0;

  float knot(float t, const BeamTile::Profile& profile) const {
    return static_cast<float>((static_cast<double>(t) + shift - profile.t_begin) /
                              static_cast<double>(profile.step));
  }
};

/// Copies the part of a ray's weights that belongs to a piece.
void copy_weights(const CutRay& ray, std::size_t piece, const BeamTile::Profile& profile,
                  std::size_t rows, const std::vector<float>& whole, int lane,
                  std::vector<float>& part) {
  const float begin = ray.knot(ray.sink.begin(piece), profile);
  const float end = ray.knot(ray.sink.end(piece), profile);
  const float last = static_cast<float>(profile.knots - 1);
  const int first = static_cast<int>(std::clamp(std::floor(begin - 1), 0.0f, last));
  const int final = static_cast<int>(std::clamp(std::ceil(end + 1), 0.0f, last));
  for (int knot = first; knot <= final; ++knot) {
    const float k = static_cast<float>(knot);
    const float share = hat_before(end - k) - hat_before(begin - k);
    if (!(share > 0))
      continue;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t at =
          profile.offset +
          (row * static_cast<std::size_t>(profile.knots) + static_cast<std::size_t>(knot)) *
              BeamTile::rays_per_subtile +
          static_cast<std::size_t>(lane);
      part[at] = share * whole[at];
    }
  }
}

} // namespace

void gather_pieces(const World& world, const PhotonMap& map, const TileRays& rays, BeamTile& tile,
                   PassImage& image) {
  std::array<CutRay, BeamTile::ray_count> cut;
  std::size_t pieces = 0;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const TileRays::PixelRay& ray = rays[static_cast<int>(i)];
    if (!ray.inside || ray.profile.empty())
      continue;
    cut[i] = {RaySink(world, ray.camera, nullptr, ray.pixel, image), tile.shift[i]};
    pieces = std::max(pieces, cut[i].sink.pieces());
  }
  const std::vector<float> whole = tile.weights;
  const int channels = map.channels();
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    std::fill(tile.weights.begin(), tile.weights.end(), 0.0f);
    std::fill(tile.radiance.begin(), tile.radiance.end(), 0.0f);
    for (std::size_t part = 0; part < tile.part_count(); ++part) {
      tile.choose_part(part);
      for (std::size_t i = 0; i < cut.size(); ++i) {
        const BeamTile::Profile& profile = tile.profiles[i / BeamTile::rays_per_subtile];
        if (piece < cut[i].sink.pieces() && profile.knots > 0)
          copy_weights(cut[i], piece, profile, tile.rows(), whole,
                       static_cast<int>(i % BeamTile::rays_per_subtile), tile.weights);
      }
    }
    map.query(tile);
    for (std::size_t i = 0; i < cut.size(); ++i) {
      if (piece >= cut[i].sink.pieces())
        continue;
      const auto value = [&](std::size_t c) { return tile.radiance[c * cut.size() + i]; };
      cut[i].sink.add_to_piece(piece,
                               channels == 1 ? Rgb(value(0)) : Rgb(value(0), value(1), value(2)));
    }
  }
}

} // namespace vdbeam
