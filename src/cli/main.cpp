#include "vdbeam/version.h"

#include <cstdio>

int main() {
  std::printf("vdbeam %s\n", vdbeam::version());
  return 0;
}
