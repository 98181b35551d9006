#pragma once

#include "image/output_formats.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace vdbeam::cli {

/// Writes images to one file by a thread of its own: whoever renders never waits for a disk. An
/// image that is not written yet is replaced by the next one.
class PreviewWriter {
public:
  /// `on_error` is called by the thread where an image cannot be written; the next one is tried
  /// anyway.
  PreviewWriter(std::string path, WriteOptions options,
                std::function<void(const std::string&)> on_error);
  PreviewWriter(const PreviewWriter&) = delete;
  PreviewWriter& operator=(const PreviewWriter&) = delete;
  /// Writes what is left.
  ~PreviewWriter();

  /// `written`, unless it is empty, is called by the thread when this image is in the file.
  void write(Image image, std::function<void()> written);
  /// Waits until all is written, but no longer than `most`: a disk may hang.
  void wait(std::chrono::milliseconds most);

private:
  struct Waiting {
    Image image;
    std::function<void()> written;
  };
  void run();

  std::string path_;
  WriteOptions options_;
  std::function<void(const std::string&)> on_error_;
  std::mutex mutex_;
  std::condition_variable changed_, idle_;
  std::optional<Waiting> next_;
  bool closing_ = false, writing_ = false;
  std::thread thread_; ///< the last member: it uses the others
};

} // namespace vdbeam::cli
