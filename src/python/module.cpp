#include "python/bindings.h"
#include "vdbeam/error.h"
#include "vdbeam/version.h"

namespace vdbeam::python {
namespace {

/// The library's errors become the package's, with the same line.
void bind_errors(py::module_& module) {
  static const py::exception<Error> base(module, "Error");
  static const py::exception<InputError> input(module, "InputError", base.ptr());
  static const py::exception<FrameError> frame(module, "FrameError", base.ptr());
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer)
        std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      PyErr_SetString(input.ptr(), error.what());
    } catch (const FrameError& error) {
      PyErr_SetString(frame.ptr(), error.what());
    } catch (const Error& error) {
      PyErr_SetString(base.ptr(), error.what());
    }
  });
}

} // namespace
} // namespace vdbeam::python

PYBIND11_MODULE(_core, module) {
  using namespace vdbeam::python;
  module.doc() = "vdbeam's library with plain arguments; use the package vdbeam";
  module.attr("version") = vdbeam::version();
  bind_errors(module);
  bind_scenes(module);
  bind_images(module);
  bind_render(module);
  bind_live(module);
}
