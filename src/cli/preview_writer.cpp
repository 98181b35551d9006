#include "cli/preview_writer.h"

#include "vdbeam/error.h"

namespace vdbeam::cli {

PreviewWriter::PreviewWriter(std::string path, WriteOptions options,
                             std::function<void(const std::string&)> on_error)
    : path_(std::move(path)), options_(std::move(options)), on_error_(std::move(on_error)),
      thread_([this] { run(); }) {}

PreviewWriter::~PreviewWriter() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PreviewWriter::write(Image image, std::function<void()> written) {
  {
    const std::lock_guard lock(mutex_);
    next_ = Waiting{std::move(image), std::move(written)};
  }
  changed_.notify_all();
}

void PreviewWriter::wait(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  idle_.wait_for(lock, most, [this] { return !next_ && !writing_; });
}

void PreviewWriter::run() {
  for (;;) {
    std::unique_lock lock(mutex_);
    writing_ = false;
    idle_.notify_all();
    changed_.wait(lock, [this] { return closing_ || next_; });
    if (!next_)
      return;
    const Waiting image = std::move(*next_);
    next_.reset();
    writing_ = true;
    lock.unlock();
    try {
      write_image(image.image, path_, options_);
      if (image.written)
        image.written();
    } catch (const Error& error) { // the disk may have room again for the next one
      on_error_(error.what());
    }
  }
}

} // namespace vdbeam::cli
