#include "vdbeam/live.h"

#include "live/light_mix.h"
#include "live/scene_changes.h"
#include "live/small_look.h"
#include "prepare/prepared_scene.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace vdbeam {
namespace {

using Clock = std::chrono::steady_clock;

/// How often images are shown: developing one takes time, and an eye sees no more.
constexpr double seconds_between_images = 0.25;

/// Clauses of what a scene has from the one before it; `same_world`: all of that one's world.
std::vector<std::string> describe_kept(const Scene& scene, const PreparedScene& now,
                                       bool same_world) {
  if (same_world)
    return {"medium, lights and surfaces, since no key that shapes them has changed"};
  const bool has_files =
      std::any_of(scene.volumes.begin(), scene.volumes.end(),
                  [](const VolumeSettings& volume) { return !volume.file.empty(); });
  std::vector<std::string> kept;
  if (has_files && now.grids_read == 0)
    kept.emplace_back("grids, since no file and no edit of a volume has changed");
  if (now.world->surfaces && now.facts.surfaces.trees_built == 0)
    kept.emplace_back("trees over meshes, since no shape has changed");
  return kept;
}

} // namespace

/// A thread renders `base_`, the last scene that could not be mixed from images of lights; `shown_`
/// is what the user wants to see.
class LiveSession::Impl {
public:
  explicit Impl(LiveHooks hooks) : hooks_(std::move(hooks)), thread_([this] { run(); }) {}
  ~Impl() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  int show(Scene scene, bool files_changed) {
    std::unique_lock lock(mutex_);
    LiveEdit edit;
    if (edits_ > 0)
      edit.changed = changed_keys(shown_, scene);
    if (edits_ > 0 && edit.changed.empty() && !files_changed && !failed_)
      return edits_; // a file that was saved as it was
    const int number = edit.edit = ++edits_;
    given_ = Clock::now();
    shown_ = std::move(scene);
    if (edits_ > 1 && !files_changed && !next_ && !failed_)
      if (auto mix = LightMix::between(grouped_, shown_)) {
        mix_ = std::move(*mix);
        edit.mixed = true;
        const bool finished = finished_;
        call(lock, hooks_.on_edit, edit);
        show_last(lock);
        if (finished)
          call(lock, hooks_.on_finished, number);
        return number;
      }
    next_ = std::move(edit);
    stop_ = true;
    lock.unlock();
    changed_.notify_all();
    return number;
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    next_.reset();
    stop_ = failed_ = true;
  }

private:
  /// The last image of `base_`.
  struct Rendered {
    Image image;        ///< with groups of lights
    bool small = false; ///< to be enlarged
    int passes = 0;
    std::optional<PassRecord> record;
  };

  void run() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return closing_ || next_; });
      if (closing_)
        return;
      LiveEdit edit = std::move(*next_);
      next_.reset();
      base_ = shown_;
      grouped_ = LightMix::with_groups(base_);
      mix_ = {};
      last_ = {};
      stop_ = failed_ = finished_ = false;
      const Scene scene = grouped_;
      lock.unlock();
      try {
        render(scene, std::move(edit));
      } catch (const Error& error) {
        lock.lock();
        if (!stop_) {
          failed_ = true;
          call(lock, hooks_.on_error, int{edits_}, std::string(error.what()));
        }
      }
    }
  }

  void render(const Scene& scene, LiveEdit edit) {
    // The old scene is released before the render, so that two are not in memory.
    PreparedScenePtr prepared = prepare_scene(scene, prepared_, &stop_);
    const bool is_first = !prepared_;
    const bool same_world = !is_first && prepared->world == prepared_->world;
    prepared_ = std::move(prepared);
    RenderStatistics work;
    add_work(work, *prepared_);
    edit.grids_read = work.grids_read;
    edit.meshes_read = work.meshes_read;
    edit.trees_built = work.trees_built;
    if (!is_first)
      edit.kept = describe_kept(scene, *prepared_, same_world);
    {
      std::unique_lock lock(mutex_);
      call(lock, hooks_.on_edit, edit);
    }
    record_.reset();
    if (std::optional<Image> look = looks_.take(scene, prepared_, stop_))
      take(std::move(*look), 0, true);
    RenderHooks hooks;
    hooks.stop = &stop_;
    hooks.discards_when_stopped = true;
    hooks.refines_quick_look = true;
    hooks.snapshot_interval.seconds = seconds_between_images;
    hooks.on_pass = [this](const PassRecord& record, const RenderStatistics&) { record_ = record; };
    hooks.on_quick_look = [this](RenderResult& result) { take(std::move(result.image), 0); };
    hooks.on_snapshot = [this](RenderResult& result, bool) {
      take(std::move(result.image), record_ ? record_->pass : 0);
    };
    RenderResult result = vdbeam::render(scene, prepared_, {}, hooks);
    if (result.stopped_by == "stop")
      return;
    take(std::move(result.image), record_ ? record_->pass : 0);
    std::unique_lock lock(mutex_);
    finished_ = !stop_;
    if (finished_)
      call(lock, hooks_.on_finished, int{edits_});
  }

  void take(Image image, int passes, bool small = false) {
    if (stop_)
      return;
    std::unique_lock lock(mutex_);
    last_ = Rendered{std::move(image), small, passes, passes > 0 ? record_ : std::nullopt};
    show_last(lock);
  }

  void show_last(std::unique_lock<std::mutex>& lock) {
    if (!last_ || !hooks_.on_image)
      return;
    std::optional<Image> image = mix_.apply(last_->image);
    if (!image)
      return;
    LiveImage shown;
    shown.image = last_->small ? enlarged(*image, base_.image) : std::move(*image);
    shown.edit = edits_;
    shown.passes = last_->passes;
    shown.mixed = !mix_.changes_nothing();
    shown.seconds = std::chrono::duration<double>(Clock::now() - given_).count();
    shown.record = last_->record;
    call(lock, hooks_.on_image, shown);
  }

  /// Calls back without the lock of the state, so that a callback may show another scene, and one
  /// at a time.
  template <class Function, class... Args>
  void call(std::unique_lock<std::mutex>& lock, const Function& function, Args&&... args) {
    if (!function)
      return;
    lock.unlock();
    {
      const std::lock_guard one_at_a_time(calls_);
      function(std::forward<Args>(args)...);
    }
    lock.lock();
  }

  LiveHooks hooks_;
  std::recursive_mutex calls_;
  std::mutex mutex_; ///< of all that follows, but for what only the thread uses
  std::condition_variable changed_;
  Scene shown_, base_;
  Scene grouped_; ///< `base_` with groups of lights
  LightMix mix_;  ///< from `base_` to `shown_`
  std::optional<Rendered> last_;
  std::optional<LiveEdit> next_;
  int edits_ = 0;
  Clock::time_point given_;
  bool closing_ = false;
  bool failed_ = false;   ///< or stopped: the next edit cannot be mixed
  bool finished_ = false; ///< the stop rule of `base_` is met
  std::atomic<bool> stop_ = false;
  // What only the thread uses:
  PreparedScenePtr prepared_;
  SmallLooks looks_;
  std::optional<PassRecord> record_;
  std::thread thread_; ///< the last member: it uses the others
};

LiveSession::LiveSession(LiveHooks hooks) : impl_(std::make_unique<Impl>(std::move(hooks))) {}
LiveSession::~LiveSession() = default;

int LiveSession::show(Scene scene, bool files_changed) {
  return impl_->show(std::move(scene), files_changed);
}

void LiveSession::stop() {
  impl_->stop();
}

} // namespace vdbeam
