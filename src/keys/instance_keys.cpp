#include "keys/scene_key_builder.h"

namespace vdbeam {

void add_instance_keys(KeyTable& table) {
  using I = InstanceSettings;
  table.section(SceneSection::instance);
  table.add("volume", &I::volume, "name of the [[volume]] that is repeated").required();
  table
      .add("file", &I::file,
           "text file with a row of numbers for each instance, instead of rows; ####, %04d or $F4 "
           "stands for the frame number")
      .file(InputKind::instances);
  table.add("columns", &I::columns,
            "meaning of the numbers of a row: x y z, rx ry rz (degrees), scale, sx sy sz, density, "
            "or m00 to m23; a file may begin with a line of them");
}

} // namespace vdbeam
