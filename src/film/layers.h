#pragma once

#include "film/film.h"
#include "vdbeam/layer_settings.h"

namespace vdbeam {

/// What is wrong with the name of a layer, or nothing. `others`: those of the scene's groups of
/// lights and of its volumes.
std::string why_no_layer(const std::string& name, const std::vector<std::string>& others);

/// The picture with the layers that are asked for, or with those that every picture has where none
/// are. R, G and B are always there. A layer that there is nothing of in the scene is left out.
Image develop_layers(const Film& film, const std::vector<LayerSettings>& layers);

/// The layers as one line of text, for a file's attribute, and back.
std::string layers_text(const std::vector<LayerSettings>& layers);
std::vector<LayerSettings> layers_of_text(const std::string& text);

} // namespace vdbeam
