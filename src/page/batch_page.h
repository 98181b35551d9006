#pragma once

#include "page/thumbnail.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// A frame as the page of its batch shows it.
struct PageFrame {
  int number = 0;
  std::string status{}; ///< "done", "skipped", "failed", "interrupted"; empty: not begun
  std::string reason{}; ///< one line: why it failed
  std::optional<int> exit_code{};
  double seconds = 0;       ///< wall clock
  std::string thumbnail{};  ///< name of a file beside the page; empty: none
  ThumbnailFacts picture{}; ///< where there is a thumbnail
};

/// Content of a batch's page (docs/how-to/sequences.md).
struct BatchPage {
  std::string scene;
  std::vector<PageFrame> frames; ///< in ascending order
  bool finished = true;          ///< else the batch goes on, and replaces the page
  /// Where and how the batch ran; several where the page joins tasks of a farm.
  std::vector<std::string> machines{}, versions{}, dates{}, commands{};
};

/// Mean relative change of brightness between neighbouring frames of the list that have an image:
/// |b - a| / ((a + b) / 2). Nothing without such a pair.
std::optional<double> flicker(const std::vector<PageFrame>& frames);

/// The page as HTML, with style and script; only thumbnails are files of their own.
std::string page_html(const BatchPage& page);

} // namespace vdbeam
