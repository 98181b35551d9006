#include "python/bindings.h"
#include "report/report.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

namespace vdbeam::python {
namespace {

/// What is kept from one render to the next.
struct Session {
  PreparedScenePtr prepared;
};

/// A frame, and the scene that it is of.
struct Frame {
  RenderResult result;
  std::string report;
};

/// Python functions that are called while a frame is rendered; each may be None. One that raises
/// ends the render, and so does one that returns False.
struct Callbacks {
  py::object on_pass, on_image, on_note;
};

/// Renders on a thread of its own, so that the thread that waits can let Python look for signals: a
/// pass may take minutes, and Python's own handlers only run on the main thread.
class RenderThread {
public:
  RenderThread(const Scene& scene, const FrameSettings& frame, Session& session,
               const Callbacks& callbacks)
      : scene_(scene), frame_(frame), session_(session), callbacks_(callbacks) {
    hooks_.stop = &stop_;
    if (!callbacks_.on_pass.is_none())
      hooks_.on_pass = [this](const PassRecord& record, const RenderStatistics&) {
        call([&] { return callbacks_.on_pass(record); });
      };
    if (!callbacks_.on_note.is_none())
      hooks_.on_note = [this](const std::string& line) {
        call([&] { return callbacks_.on_note(line); });
      };
    if (!callbacks_.on_image.is_none()) {
      snapshot_ = true;
      hooks_.snapshot = &snapshot_;
      hooks_.on_snapshot = [this](RenderResult& result, bool) {
        snapshot_ = true; // after the next pass as well
        call([&] { return callbacks_.on_image(std::make_shared<Image>(result.image)); });
      };
    }
  }

  /// Called with Python's lock, which it gives away meanwhile.
  std::shared_ptr<Frame> run() {
    {
      const py::gil_scoped_release unlocked;
      std::thread thread([this] { work(); });
      wait();
      thread.join();
    }
    if (raised_)
      std::rethrow_exception(raised_);
    return std::move(result_);
  }

private:
  void work() {
    try {
      session_.prepared = prepare_scene(scene_, session_.prepared, &stop_);
      auto frame = std::make_shared<Frame>();
      frame->result = render(scene_, session_.prepared, frame_, hooks_);
      ReportContext context;
      context.scene_hash = scene_hash(scene_);
      frame->report = json_text(report_json(scene_, frame->result, context));
      result_ = std::move(frame);
    } catch (...) {
      raise(std::current_exception());
    }
    const std::lock_guard lock(mutex_);
    done_ = true;
    finished_.notify_one();
  }

  void wait() {
    constexpr std::chrono::milliseconds between_looks(50);
    std::unique_lock lock(mutex_);
    while (!finished_.wait_for(lock, between_looks, [this] { return done_; })) {
      lock.unlock();
      call([] {
        if (PyErr_CheckSignals() != 0)
          throw py::error_already_set();
        return py::none();
      });
      lock.lock();
    }
  }

  template <class Function>
  void call(const Function& function) {
    const py::gil_scoped_acquire locked;
    try {
      const py::object answer = function();
      if (answer.is(py::bool_(false)))
        stop_ = true;
    } catch (...) {
      raise(std::current_exception());
    }
  }

  /// Keeps the first exception, which ended what came later.
  void raise(const std::exception_ptr& exception) {
    const std::lock_guard lock(raise_mutex_);
    if (!raised_)
      raised_ = exception;
    stop_ = true;
  }

  const Scene& scene_;
  const FrameSettings& frame_;
  Session& session_;
  const Callbacks& callbacks_;
  RenderHooks hooks_;
  std::atomic<bool> stop_ = false, snapshot_ = false;
  std::mutex mutex_, raise_mutex_;
  std::condition_variable finished_;
  bool done_ = false;
  std::exception_ptr raised_;
  std::shared_ptr<Frame> result_;
};

std::shared_ptr<Frame> render_frame(const Scene& scene, Session& session,
                                    const std::optional<FloatArray>& reference,
                                    const std::optional<FloatArray>& second_reference,
                                    const Callbacks& callbacks) {
  FrameSettings frame;
  std::optional<Image> first, second;
  if (reference)
    frame.reference = &first.emplace(image_of(*reference));
  if (second_reference)
    frame.second_reference = &second.emplace(image_of(*second_reference));
  return RenderThread(scene, frame, session, callbacks).run();
}

} // namespace

void bind_render(py::module_& module) {
  py::class_<PassRecord>(module, "PassRecord", "The state of the image after a pass.")
      .def_readonly("passes", &PassRecord::pass, "Number of passes so far.")
      .def_readonly("seconds", &PassRecord::seconds, "Time since rendering began [s].")
      .def_readonly("photons", &PassRecord::photons, "Photons stored in this pass.")
      .def_readonly("error_estimate", &PassRecord::error_estimate,
                    "Expected error (MRSE) of the image; NaN while it is unknown.")
      .def_readonly("error_low", &PassRecord::error_low, "Lower end of its 95 % interval.")
      .def_readonly("error_high", &PassRecord::error_high, "Upper end of its 95 % interval.")
      .def_readonly("noise_estimate", &PassRecord::noise_estimate, "The part that is noise.")
      .def_readonly("bias_estimate", &PassRecord::bias_estimate,
                    "Mean brightness over the true one, less 1.")
      .def_readonly("mrse", &PassRecord::mrse, "Error against the reference, where there is one.")
      .def_readonly("has_reference", &PassRecord::has_reference,
                    "Whether the render was compared with a reference image.");
  py::class_<Session>(module, "Session").def(py::init<>());
  py::class_<Frame, std::shared_ptr<Frame>>(module, "Frame")
      .def_property_readonly("planes",
                             [](const std::shared_ptr<Frame>& frame) {
                               return planes_of(frame->result.image, py::cast(frame));
                             })
      .def_property_readonly(
          "image", [](const Frame& frame) { return std::make_shared<Image>(frame.result.image); })
      .def_property_readonly("passes", [](const Frame& frame) { return frame.result.passes; })
      .def_property_readonly("notes", [](const Frame& frame) { return frame.result.notes; })
      .def_readonly("report", &Frame::report);
  module.def(
      "render",
      [](const Scene& scene, Session& session, const std::optional<FloatArray>& reference,
         const std::optional<FloatArray>& second_reference, const py::object& on_pass,
         const py::object& on_image, const py::object& on_note) {
        return render_frame(scene, session, reference, second_reference,
                            {on_pass, on_image, on_note});
      },
      py::arg("scene"), py::arg("session"), py::arg("reference"), py::arg("second_reference"),
      py::arg("on_pass"), py::arg("on_image"), py::arg("on_note"));
}

} // namespace vdbeam::python
