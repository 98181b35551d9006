#pragma once

#include "batch/batch_summary.h"
#include "page/batch_page.h"
#include "report/frame_files.h"

#include <map>
#include <span>
#include <string>

namespace vdbeam::cli {

/// Writes the page of a batch and its thumbnails to the folder of --html. Does nothing where there
/// is none.
class PageWriter {
public:
  /// `exposure` [stops] and `view` are those of previews.
  PageWriter(const FrameFiles& files, double exposure, const std::string& view)
      : files_(files), exposure_(exposure), view_(view) {}

  /// Makes the folder where it is missing. Throws FrameError.
  void make_folder() const;

  /// Makes the thumbnail of a frame that is done or skipped. Where that fails, the frame has none
  /// and `problem` says why.
  void add(const FrameOutcome& outcome, const std::string& image);

  /// Replaces the page in one step by that of `batches`, which are tasks of one shot: of frames
  /// that several of them rendered, the outcome of the latest date counts. Throws FrameError.
  void write(std::span<const BatchSummary> batches, bool finished) const;

  /// The last line about a thumbnail that could not be made; empty: there is none.
  const std::string& problem() const { return problem_; }

private:
  FrameFiles files_;
  double exposure_;
  std::string view_;
  std::map<int, ThumbnailFacts> pictures_; ///< of the frames that have thumbnails
  std::string problem_;
};

/// The outcomes of all batches by frame; of a frame that several have, that of the latest date, or
/// of the last of them where dates are equal.
std::map<int, FrameOutcome> outcomes_by_frame(std::span<const BatchSummary> batches);

} // namespace vdbeam::cli
