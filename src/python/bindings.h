#pragma once

#include "vdbeam/render.h"

#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

// The module vdbeam._core: the library's functions with plain arguments. The package vdbeam, which
// is written in Python, makes of them what users see.

namespace vdbeam::python {

namespace py = pybind11;

using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

void bind_scenes(py::module_& module);
void bind_images(py::module_& module);
void bind_render(py::module_& module);
void bind_live(py::module_& module);

/// The planes of an image, by name, as arrays of height by width values that share its memory and
/// keep `owner` alive.
py::dict planes_of(Image& image, const py::object& owner);
/// An image with the channels R, G and B of an array of height by width by 3 values.
Image image_of(const FloatArray& rgb);

} // namespace vdbeam::python
