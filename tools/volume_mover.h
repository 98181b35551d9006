#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// Volumes moved by their own velocity, by brute force: what motion blur is compared with. Shares
/// no code with the renderer.

struct MoveOptions {
  std::string velocity = "velocity"; ///< a grid of vectors, at voxels or staggered
  double fps = 24;                   ///< frames in a second: velocities are lengths per second
  double scale = 1;                  ///< factor of the velocities
  bool index = false; ///< velocities are in voxels of their grid, not in units of the world
};

/// The middles of `count` equal parts of the time from `open` to `close`.
std::vector<double> middle_times(double open, double close, int count);

/// Writes every grid of floats in the VDB `from` to `to` as the velocity carries it in `frames`:
/// each point p goes straight to p + t v(p) and takes its value along, so a voxel at x gets the
/// value at the p that comes there. Voxels lie as before. Where the velocity has no active voxel,
/// the mean of the nearest ones holds. Throws InputError where the file has no such velocity, and
/// openvdb::Exception where a file cannot be read or written.
void move_volume(const std::string& from, const std::string& to, double frames,
                 const MoveOptions& options = {});

} // namespace vdbeam
