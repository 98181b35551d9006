#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>

namespace vdbeam::cli {

/// Makes the standard streams harmless; the first thing that the program does. Of the descriptors 0
/// to 2 those that are closed are opened, on something that can be neither read nor written, so
/// that no file of a render gets their numbers. A write to a broken pipe or beyond a limit of file
/// size becomes an error instead of a signal that ends the program.
void guard_standard_streams();

/// Writes to the log, which is stderr. A log that is full, closed or broken loses lines; it never
/// costs a frame. Nor does one that nobody reads, which loses them after a fifth of a second; once
/// it is read again a line says how many are missing.
void log_text(std::string_view text);

/// The same for a signal handler: the line is lost where the log is in use or not ready at once.
void log_from_signal(std::string_view line);

/// One line for the log. Control characters that a file's name, a library or a damaged file put in
/// it are shown, not sent to the terminal.
void log_line(std::string_view line);
/// The same for an error, in red on a terminal that shows colours.
void log_error(std::string_view line);

template <class... Args>
void log(fmt::format_string<Args...> format, Args&&... args) {
  log_line(fmt::format(format, std::forward<Args>(args)...));
}

/// Writes to stdout what a render can do without: progress for a farm's engine. May be lost as the
/// log may.
void progress_text(std::string_view text);

/// Writes a file that the user asked to be stdout. Throws FrameError where that is not possible.
void write_stdout(std::string_view text);

/// Writes the output of a command whose output is stdout. Throws FrameError as write_stdout; a
/// reader that has gone away (`vdbeam info ... | head -1`) ends the program without a word, as it
/// does for every other program of a pipe.
/// The bytes are written as they are: a scene, a job or JSON.
void print_output(std::string_view text);
/// The same for text that people read, which may hold names from files: control characters but line
/// breaks are shown, not sent to the terminal.
void print_text(std::string_view text);

} // namespace vdbeam::cli
