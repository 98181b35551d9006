#pragma once

namespace vdbeam {

/// A frame of a sequence and the time at which animated keys are evaluated. A whole frame is
/// evaluated at its own time, so an `int` converts to a FrameTime; motion samples of an open
/// shutter have other times of the same frame.
struct FrameTime {
  int number = 1;  ///< number of the frame, for file names and random numbers
  double time = 1; ///< time of animated keys [frames]

  constexpr FrameTime() = default;
  constexpr FrameTime(int frame) : number(frame), time(frame) {} ///< of a whole frame
  constexpr FrameTime(int frame, double at) : number(frame), time(at) {}
};

} // namespace vdbeam
