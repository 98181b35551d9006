#include <vdbeam/version.h>

#include <cstdio>

int main() {
  std::printf("built on vdbeam %s\n", vdbeam::version());
  return 0;
}
