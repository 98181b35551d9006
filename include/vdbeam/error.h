#pragma once

#include <stdexcept>
#include <string>

namespace vdbeam {

/// Exit codes of the command-line program; the library throws the errors below.
enum class ExitCode : int {
  success = 0,
  internal_error = 1,
  bad_input = 2,
  frame_failed = 3,
  interrupted = 130,
  terminated = 143,
};

/// An error with one line for the user: what is wrong, where, and the remedy.
class Error : public std::runtime_error {
public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  ExitCode code() const { return code_; }

private:
  ExitCode code_;
};

/// The user's input (scene, option, file contents) cannot be used as it is.
class InputError : public Error {
public:
  explicit InputError(const std::string& line) : Error(ExitCode::bad_input, line) {}
};

/// A frame could not be finished: unreadable volume, full disk, not enough memory.
class FrameError : public Error {
public:
  explicit FrameError(const std::string& line) : Error(ExitCode::frame_failed, line) {}
};

} // namespace vdbeam
