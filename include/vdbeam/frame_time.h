#pragma once

namespace vdbeam {

/// A frame of a sequence, and the moment at which it is looked at. Every whole frame is looked at
/// at its own time, so an `int` is a FrameTime; a shutter that is open for a while sees other
/// moments of the same frame.
struct FrameTime {
  int number = 1;  ///< which frame: in file names, and as the key of random numbers
  double time = 1; ///< when animated keys are evaluated [frames]

  constexpr FrameTime() = default;
  constexpr FrameTime(int frame) : number(frame), time(frame) {} ///< of a whole frame
  constexpr FrameTime(int frame, double at) : number(frame), time(at) {}
};

} // namespace vdbeam
