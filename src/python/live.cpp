#include "vdbeam/live.h"
#include "python/bindings.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace vdbeam::python {
namespace {

/// Python functions that a session calls, each with Python's lock; each may be None. One that
/// raises ends the render in progress, and so does one that returns False.
struct LiveCallbacks {
  py::object on_image, on_edit, on_error, on_finished;
};

/// Callbacks under way on this thread: one of them must not wait for its own session to end.
thread_local int callbacks_under_way = 0;

/// Ends a session, whose thread may be in a callback, waiting for Python's lock, or be this one.
struct EndSession {
  void operator()(LiveSession* session) const {
    if (callbacks_under_way > 0)
      return std::thread([session] { delete session; }).detach();
    std::optional<py::gil_scoped_release> unlocked;
    if (PyGILState_Check() != 0)
      unlocked.emplace();
    delete session;
  }
};

py::object exception_of(const std::string& line, bool input) {
  return py::module_::import("vdbeam._core").attr(input ? "InputError" : "FrameError")(line);
}

/// What the callbacks of a session need; it lives as long as the session.
class LiveState {
public:
  explicit LiveState(LiveCallbacks callbacks) : callbacks_(std::move(callbacks)) {}
  LiveState(const LiveState&) = delete;
  LiveState& operator=(const LiveState&) = delete;
  ~LiveState() {
    const py::gil_scoped_acquire locked;
    callbacks_ = {};
    raised_ = nullptr;
    error_ = py::object();
  }

  static LiveHooks hooks(const std::shared_ptr<LiveState>& state) {
    LiveHooks hooks;
    hooks.on_image = [state](LiveImage& image) { state->take(image); };
    hooks.on_edit = [state](const LiveEdit& edit) {
      state->call([&] { return state->callbacks_.on_edit; }, edit);
    };
    hooks.on_error = [state](int edit, const std::string& line) { state->fail(edit, line); };
    hooks.on_finished = [state](int edit) {
      state->call([&] { return state->callbacks_.on_finished; }, edit);
      state->end(edit);
    };
    return hooks;
  }

  void serve(const std::shared_ptr<LiveSession>& session) { session_ = session; }
  /// Before a scene is shown.
  void begin() {
    const std::lock_guard lock(mutex_);
    stopped_ = false;
  }
  /// Ends the render: nothing more comes before another scene is shown.
  void stop() {
    if (const std::shared_ptr<LiveSession> session = session_.lock())
      session->stop();
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }
  std::shared_ptr<LiveImage> latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
  }

  /// Called with Python's lock. Raises what a callback has raised.
  void rethrow() {
    if (std::exception_ptr raised = std::exchange(raised_, nullptr))
      std::rethrow_exception(raised);
  }

  /// Waits until an edit is finished, has failed or was stopped; false where the time is over.
  /// Called with Python's lock, which it gives away; looks for signals meanwhile.
  bool wait(int edit, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    constexpr std::chrono::milliseconds between_looks(50);
    for (;;) {
      bool done = false;
      {
        const py::gil_scoped_release unlocked;
        std::unique_lock lock(mutex_);
        done = changed_.wait_for(lock, between_looks, [&] { return stopped_ || ended_ >= edit; });
      }
      if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
      rethrow();
      if (done && failed_ >= edit && error_) {
        PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error_.ptr())), error_.ptr());
        throw py::error_already_set();
      }
      if (done || std::chrono::steady_clock::now() > end)
        return done;
    }
  }

private:
  void take(LiveImage& image) {
    auto taken = std::make_shared<LiveImage>(std::move(image));
    {
      const std::lock_guard lock(mutex_);
      latest_ = taken;
    }
    call([&] { return callbacks_.on_image; }, taken);
  }

  void fail(int edit, const std::string& line) {
    bool input = false;
    try {
      std::rethrow_exception(std::current_exception());
    } catch (const InputError&) {
      input = true;
    } catch (...) { // a frame's
    }
    {
      const py::gil_scoped_acquire locked;
      error_ = exception_of(line, input);
      failed_ = edit;
    }
    call([&] { return callbacks_.on_error; }, error_);
    end(edit);
  }

  void end(int edit) {
    const std::lock_guard lock(mutex_);
    ended_ = std::max(ended_, edit);
    changed_.notify_all();
  }

  template <class Find, class Argument>
  void call(const Find& find, const Argument& argument) {
    const py::gil_scoped_acquire locked;
    ++callbacks_under_way;
    try {
      if (const py::object function = find(); function && !function.is_none())
        if (function(argument).is(py::bool_(false)))
          stop();
    } catch (...) {
      if (!raised_)
        raised_ = std::current_exception();
      stop();
    }
    --callbacks_under_way;
  }

  std::weak_ptr<LiveSession> session_;
  // Under Python's lock:
  LiveCallbacks callbacks_;
  std::exception_ptr raised_; ///< by a callback
  py::object error_;          ///< of the edit `failed_`
  int failed_ = 0;
  // Under this one:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<LiveImage> latest_;
  int ended_ = 0;
  bool stopped_ = false;
};

/// A LiveSession whose callbacks are Python's.
class Live {
public:
  explicit Live(LiveCallbacks callbacks)
      : state_(std::make_shared<LiveState>(std::move(callbacks))),
        session_(new LiveSession(LiveState::hooks(state_)), EndSession()) {
    state_->serve(session_);
  }
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;
  ~Live() { close(); }

  void show(const Scene& scene, bool files_changed) {
    state_->rethrow();
    const std::shared_ptr<LiveSession> session = open_session();
    state_->begin();
    const py::gil_scoped_release unlocked;
    edit_ = session->show(scene, files_changed);
  }

  void stop() {
    const py::gil_scoped_release unlocked;
    state_->stop();
  }

  std::shared_ptr<LiveImage> wait(double seconds) {
    const std::shared_ptr<LiveSession> session = open_session();
    if (callbacks_under_way > 0)
      throw std::runtime_error("a callback cannot wait for its own session");
    return state_->wait(edit_, seconds) ? state_->latest() : nullptr;
  }

  std::shared_ptr<LiveImage> latest() const { return state_->latest(); }

  void close() {
    if (session_)
      stop();
    session_.reset();
  }

private:
  std::shared_ptr<LiveSession> open_session() const {
    if (!session_)
      throw std::runtime_error("the session is closed");
    return session_;
  }

  std::shared_ptr<LiveState> state_;
  std::shared_ptr<LiveSession> session_; ///< null: closed
  std::atomic<int> edit_ = 0;            ///< that was shown last
};

void bind_live_image(py::module_& module) {
  py::class_<LiveImage, std::shared_ptr<LiveImage>>(module, "LiveImage")
      .def_property_readonly("planes",
                             [](const std::shared_ptr<LiveImage>& shown) {
                               return planes_of(shown->image, py::cast(shown));
                             })
      .def_property_readonly("image",
                             [](const std::shared_ptr<LiveImage>& shown) {
                               return std::shared_ptr<Image>(shown, &shown->image);
                             })
      .def_readonly("edit", &LiveImage::edit)
      .def_readonly("passes", &LiveImage::passes)
      .def_readonly("mixed", &LiveImage::mixed)
      .def_readonly("seconds", &LiveImage::seconds)
      .def_readonly("record", &LiveImage::record);
  py::class_<LiveEdit>(module, "LiveEdit", "What a live session did with a scene.")
      .def_readonly("edit", &LiveEdit::edit, "Number of the scene, from 1.")
      .def_readonly("changed", &LiveEdit::changed,
                    "Paths of the keys that differ from the last, and of tables that came or went.")
      .def_readonly("mixed", &LiveEdit::mixed, "Whether nothing is rendered anew.")
      .def_readonly("grids_read", &LiveEdit::grids_read, "Grids read for it.")
      .def_readonly("meshes_read", &LiveEdit::meshes_read, "Meshes read for it.")
      .def_readonly("trees_built", &LiveEdit::trees_built, "Trees over meshes built for it.")
      .def_readonly("kept", &LiveEdit::kept, "What was kept of the scene before, and why.");
}

} // namespace

void bind_live(py::module_& module) {
  bind_live_image(module);
  py::class_<Live>(module, "LiveSession")
      .def(py::init([](const py::object& on_image, const py::object& on_edit,
                       const py::object& on_error, const py::object& on_finished) {
             return std::make_unique<Live>(LiveCallbacks{on_image, on_edit, on_error, on_finished});
           }),
           py::arg("on_image"), py::arg("on_edit"), py::arg("on_error"), py::arg("on_finished"))
      .def("show", &Live::show, py::arg("scene"), py::arg("files_changed"))
      .def("stop", &Live::stop)
      .def("wait", &Live::wait, py::arg("seconds"))
      .def("close", &Live::close)
      .def_property_readonly("latest", &Live::latest);
}

} // namespace vdbeam::python
