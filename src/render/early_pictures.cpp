#include "film/layers.h"
#include "render/develop_bands.h"
#include "render/pass_loop.h"
#include "render/pass_window.h"
#include "render/quick_look.h"
#include "text/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

// Images before the last pass: quick looks and drafts before the first one, snapshots after it.

namespace vdbeam {

namespace {

/// How long a quick look may take.
constexpr std::chrono::milliseconds quick_look_time{250};

/// Pixels across the first draft, and the least and greatest factor by which a picture has more.
constexpr double draft_width = 120;
constexpr int least_reduction = 2, greatest_reduction = 16;
/// How many times more pixels across a second quick look has.
constexpr double finer = 2.7;
/// Pictures of fewer pixels have their first pass soon enough.
constexpr double worth_drafting = 2e5;
/// Time of a pass and its pilots in units of a draft's, per pixel, and of enlarging in units of a
/// pass: guesses from drafts and passes of clouds (research-log/decisions.md). They are no part of
/// any picture, but decide whether there is time for it.
constexpr double pilot_over_draft = 2.5, pilot_of_next_draft = 1.5, enlarging = 0.08;

} // namespace

/// Develops what is no pass, and enters no film.
void PassLoop::take_picture(const std::function<PassImage(const PixelRegion&)>& image_of) {
  std::mutex mutex;
  const auto part = [&](const PixelRegion& region) {
    PassImage image = image_of(region);
    const std::scoped_lock lock(mutex);
    clamp(image);
    return image;
  };
  std::uint64_t invalid = 0;
  result_.image = develop_bands(
      window_, part, [&](int width, int height) { return make_film(width, height); }, scene_.layers,
      invalid);
  finish_image();
  if (invalid > 0)
    note(fmt::format("{} pixel values were not finite and count as 0", invalid));
}

/// Renders a quick look into the result's image.
void PassLoop::take_quick_look(EstimatorInput input, const StopToken& stop, PassImage& image) {
  input.stop = &stop;
  fill_with_quick_look(input, image);
  take_picture([&](const PixelRegion& part) { return cut_out(image, part); });
}

/// Shows the caller what `take` puts into the result's image, and forgets it.
void PassLoop::show(const std::function<void()>& take) {
  const RenderStatistics before = result_.statistics;
  result_.quick_look = true;
  take();
  if (!stop_.requested()) // else it may be cut off, and nobody waits for it
    attempt([&] { hooks_.on_quick_look(result_); });
  result_.statistics = before;
  result_.quick_look = false;
  result_.image = {};
}

void PassLoop::show_quick_look(EstimatorInput input) {
  if (!hooks_.on_quick_look || draft_ || film_.passes() > 0 || stop_.stopped())
    return;
  StopToken soon(hooks_.stop);
  soon.set_deadline(Clock::now() + quick_look_time);
  PassImage image;
  show([&] { take_quick_look(input, soon, image); });
}

bool PassLoop::may_draft() const {
  return Draft::can_show(scene_) && film_.passes() == 0 && !frame_.pass_range && !stop_.stopped();
}

/// 1 where the first pass is likely to be finished in time.
int PassLoop::affordable_reduction() const {
  const double pilot = draft_->pilot_seconds();
  const double pass = draft_->pass_seconds() * draft_->reduction() * draft_->reduction();
  if (pilot_over_draft * pilot + pass <= limit_seconds() - seconds())
    return 1;
  const double left = limit_seconds(Packing::quick) - seconds();
  for (int reduction = least_reduction; reduction < draft_->reduction(); ++reduction)
    if (pilot_of_next_draft * pilot + pass / (reduction * reduction) + enlarging * pass <= left)
      return reduction;
  return draft_->reduction();
}

bool PassLoop::draft(const PreparedScenePtr& prepared, const EstimatorInput& full) {
  const bool limited = std::isfinite(limit_seconds());
  const double width = window_.width();
  const bool shown = hooks_.on_quick_look && width * window_.height() >= worth_drafting;
  const auto reduction = static_cast<int>(std::lround(width / draft_width));
  if (!may_draft() || reduction < least_reduction || (!limited && !shown))
    return false;
  set_deadline(Packing::quick);
  draft_ = std::make_unique<Draft>(scene_, prepared, window_,
                                   std::min(reduction, greatest_reduction), stop_);
  if (!draft_->add_pass()) {
    draft_.reset();
    return false; // and there is no time for a pass
  }
  const int affordable = limited ? affordable_reduction() : 1;
  if (affordable == 1) {
    if (shown)
      show([&] { take_enlarged(full); });
    if (shown && hooks_.refines_quick_look)
      refine_draft(prepared, full);
    set_deadline();
    return false;
  }
  if (affordable < draft_->reduction()) {
    auto finer = std::make_unique<Draft>(scene_, prepared, window_, affordable, stop_);
    if (finer->add_pass())
      draft_ = std::move(finer);
  }
  const double pass = draft_->pass_seconds();
  const double end = enlarging * pass * draft_->reduction() * draft_->reduction();
  while (seconds() + pass + end <= limit_seconds(Packing::quick) && draft_->add_pass())
    continue;
  stop(stop_.requested() ? "stop" : "time");
  take_draft(full);
  return true;
}

/// Shows the caller a draft of more pixels.
void PassLoop::refine_draft(const PreparedScenePtr& prepared, const EstimatorInput& full) {
  const int reduction = std::max(1, static_cast<int>(std::lround(draft_->reduction() / finer)));
  if (reduction < least_reduction)
    return;
  auto draft = std::make_unique<Draft>(scene_, prepared, window_, reduction, stop_);
  if (!draft->add_pass())
    return;
  draft_ = std::move(draft);
  show([&] { take_enlarged(full); });
}

/// The image of a frame without any pass: the draft or, without one, a quick look.
void PassLoop::take_early_picture(const EstimatorInput& quick_look) {
  if (draft_)
    return take_draft(quick_look);
  StopToken soon;
  soon.set_deadline(Clock::now() + quick_look_time);
  take_quick_look(quick_look, soon, image_);
  if (deep_layout_) // without samples
    result_.deep = DeepFilm(window_layout()).develop(1, window_.width(), window_.height());
  result_.quick_look = true;
  // For the report; the program has words of its own for it.
  result_.notes.emplace_back("no pass was finished: the image is a quick look, for viewing only");
}

void PassLoop::take_enlarged(const EstimatorInput& full) {
  draft_->look_through();
  take_picture([&](const PixelRegion& part) { return draft_->enlarged(full, part); });
}

/// Makes the draft the frame's picture.
void PassLoop::take_draft(const EstimatorInput& full) {
  EstimatorInput whole = full;
  whole.stop = nullptr; // the frame has ended, and this is what is left of it
  take_enlarged(whole);
  result_.draft = draft_->reduction();
  result_.quick_look = result_.stopped_by == "stop";
  note(fmt::format("there was no time for a pass: the image is a draft, {} at 1/{} of the "
                   "resolution, enlarged; allow more time or render fewer pixels",
                   count_text(static_cast<std::uint64_t>(draft_->passes()), "pass"),
                   draft_->reduction()));
}

bool PassLoop::snapshot_is_due() const {
  const SnapshotInterval& interval = hooks_.snapshot_interval;
  if (!interval.wanted() ||
      film_.passes() >= scene_.render.passes.value_or(std::numeric_limits<int>::max()))
    return false;
  const bool by_time = interval.seconds > 0 && (last_snapshot_passes_ == 0 ||
                                                since_snapshot_.seconds() >= interval.seconds);
  return by_time ||
         (interval.passes > 0 && film_.passes() - last_snapshot_passes_ >= interval.passes);
}

/// Shows the caller the image so far where it was asked for or is due.
void PassLoop::take_snapshot() {
  const bool asked = hooks_.snapshot && hooks_.snapshot->exchange(false);
  if (!hooks_.on_snapshot || (!asked && !snapshot_is_due()))
    return;
  result_.image = develop_layers(film_, scene_.layers); // deep images are no part of snapshots
  finish_image();
  attempt([&] { hooks_.on_snapshot(result_, asked); });
  since_snapshot_.restart();
  last_snapshot_passes_ = film_.passes();
}

} // namespace vdbeam
