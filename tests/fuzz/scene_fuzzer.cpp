// libFuzzer on the scene parser:
//   cmake --preset fuzz && cmake --build --preset fuzz
//   build/fuzz/tests/fuzz/vdbeam_fuzz_scene -dict=tests/fuzz/scene.dict NEW_INPUTS
//   tests/fuzz/corpus
#include "fuzz/scene_case.h"

#include <cstdio>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/dev/shm/vdbeam_fuzz_" + std::to_string(::getpid()) + ".toml";
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string complaint = vdbeam::test::read_scene_bytes(bytes, path);
  if (!complaint.empty()) {
    std::fprintf(stderr, "%s\n", complaint.c_str());
    std::abort();
  }
  return 0;
}
