#include "report/versions.h"

#include "image/image_readers.h"
#include "photonmap/photon_map.h"
#include "vdb/vdb_reader.h"
#include "vdbeam/version.h"

#include <tbb/version.h>

namespace vdbeam {

std::vector<std::pair<std::string, std::string>> component_versions() {
  std::string vdb = vdb_library_version(); // "OpenVDB 10.0.1"
  vdb.erase(0, vdb.rfind(' ') + 1);
  return {{"vdbeam", version()},
          {"OpenVDB", vdb},
          {"oneTBB", TBB_runtime_version()},
          {"OpenEXR", exr_library_version()},
          {"SIMD", simd_target()}};
}

} // namespace vdbeam
