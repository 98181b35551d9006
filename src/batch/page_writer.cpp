#include "batch/page_writer.h"

#include "machine/atomic_file.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;

void add_new(std::vector<std::string>& list, const std::string& text) {
  if (!text.empty())
    list.push_back(text);
}

} // namespace

std::map<int, FrameOutcome> outcomes_by_frame(std::span<const BatchSummary> batches) {
  std::vector<const BatchSummary*> ordered;
  for (const BatchSummary& batch : batches)
    ordered.push_back(&batch);
  // Dates of this form are ordered as texts are.
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto* a, const auto* b) { return a->origin.date < b->origin.date; });
  std::map<int, FrameOutcome> outcomes;
  for (const BatchSummary* batch : ordered)
    for (const FrameOutcome& outcome : batch->outcomes)
      outcomes[outcome.frame] = outcome;
  return outcomes;
}

void PageWriter::make_folder() const {
  std::error_code error;
  if (files_.html.empty() || fs::is_directory(files_.html, error))
    return;
  if (!fs::create_directory(files_.html, error) && error)
    throw FrameError(
        fmt::format("--html {}: the folder cannot be made: {}", files_.html, error.message()));
}

void PageWriter::add(const FrameOutcome& outcome, const std::string& image) {
  if (files_.html.empty() || (outcome.status != "done" && outcome.status != "skipped"))
    return;
  try {
    ThumbnailFacts facts = make_thumbnail(
        image, output_path(files_, Output::thumbnail, outcome.frame), exposure_, view_);
    if (!facts.error) { // an image without attributes
      facts.error = outcome.error;
      facts.error_low = outcome.error_low;
      facts.error_high = outcome.error_high;
    }
    pictures_[outcome.frame] = facts;
  } catch (const Error& error) {
    problem_ = error.what();
  }
}

void PageWriter::write(std::span<const BatchSummary> batches, bool finished) const {
  if (files_.html.empty())
    return;
  BatchPage page;
  page.finished = finished;
  std::set<int> numbers;
  for (const BatchSummary& batch : batches) {
    page.scene = batch.scene;
    numbers.insert(batch.frames.begin(), batch.frames.end());
    add_new(page.machines, machine_text(batch.origin));
    add_new(page.versions, versions_text(batch.origin));
    add_new(page.dates, batch.origin.date);
    add_new(page.commands, batch.origin.command);
  }
  const std::map<int, FrameOutcome> outcomes = outcomes_by_frame(batches);
  for (const auto& [number, outcome] : outcomes)
    numbers.insert(number);
  for (const int number : numbers) {
    PageFrame frame;
    frame.number = number;
    if (const auto found = outcomes.find(number); found != outcomes.end()) {
      const FrameOutcome& outcome = found->second;
      frame.status = outcome.status;
      frame.reason = outcome.reason;
      frame.exit_code = outcome.exit_code;
      frame.seconds = outcome.seconds;
    }
    if (const auto found = pictures_.find(number); found != pictures_.end()) {
      frame.thumbnail = fs::path(output_path(files_, Output::thumbnail, number)).filename();
      frame.picture = found->second;
    }
    page.frames.push_back(std::move(frame));
  }
  const std::string html = page_html(page);
  AtomicFile file(output_path(files_, Output::page, 0));
  file.write(html.data(), html.size());
  file.commit();
}

} // namespace vdbeam::cli
