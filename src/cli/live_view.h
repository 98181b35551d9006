#pragma once

#include "cli/preview_writer.h"
#include "console/display.h"
#include "vdbeam/live.h"

#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vdbeam::cli {

struct LiveViewOptions {
  std::string name;    ///< of the image in a viewer
  std::string preview; ///< file; empty: none
  std::string display; ///< HOST:PORT; empty: none
  std::string view;    ///< view transform of the preview
  double exposure = 0; ///< of the preview [stops]
  bool quiet = false;
};

/// Shows a live session to the user: the preview, the viewer, the log and events. Any thread may
/// call.
class LiveView {
public:
  explicit LiveView(LiveViewOptions options);
  ~LiveView();

  void show(LiveImage& shown);
  void report(const LiveEdit& edit);
  void report_end(int edit);
  void report_error(const std::string& line);
  /// The scene can be read again, and is the scene that is shown.
  void report_repaired();

private:
  nlohmann::ordered_json image_event(const LiveImage& shown) const;
  // These need the lock:
  void show_status(const std::string& text); ///< on a terminal, a line that changes
  void clear_status();
  void print(const std::string& line);

  const LiveViewOptions options_;
  std::mutex mutex_; ///< of the next members, and of the terminal
  bool status_line_, status_shown_ = false;
  bool finished_ = false;
  std::string progress_; ///< passes and error of the last image
  /// Why the last preview was not written; empty: it was. Used by the writer's thread alone.
  std::string write_error_;
  // The last members: their threads use the others.
  std::unique_ptr<Display> display_;
  std::unique_ptr<PreviewWriter> writer_;
};

} // namespace vdbeam::cli
