// Preloaded into vdbeam by failing_disk_test.py: lets one function of the C library fail on output
// files, as a full disk or a lost network mount would. VDBEAM_TEST_FAULT is "FUNCTION ERRNO WORD":
// files whose names hold WORD and end in ".tmp" are affected. An ERRNO of -1 makes the call say so
// on stderr and never return.
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace {

bool is_output(const std::string& path, const std::string& word) {
  constexpr const char* ending = ".tmp";
  return path.size() > 4 && path.compare(path.size() - 4, 4, ending) == 0 &&
         path.find(word) != std::string::npos;
}

/// The error that this call shall give; 0 for none.
int fault(const char* function, const std::string& path) {
  const char* wanted = std::getenv("VDBEAM_TEST_FAULT");
  char name[32] = "", word[128] = "";
  int error = 0;
  if (!wanted || std::sscanf(wanted, "%31s %d %127s", name, &error, word) != 3 ||
      std::strcmp(name, function) != 0)
    return 0;
  if (!is_output(path, word))
    return 0;
  if (error == -1) {
    const char text[] = "waiting\n";
    if (::write(STDERR_FILENO, text, sizeof text - 1) > 0)
      while (true)
        ::pause();
  }
  return error;
}

std::string path_of(int descriptor) {
  char path[PATH_MAX] = "";
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  return ::readlink(link.c_str(), path, sizeof path - 1) > 0 ? path : "";
}

template <class F>
F next(const char* function, F) {
  return reinterpret_cast<F>(::dlsym(RTLD_NEXT, function));
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if (const int error = fault("open", path)) {
    errno = error;
    return -1;
  }
  return next("open", &open)(path, flags, mode);
}

/// The stream's own write(2) cannot be replaced; half of the bytes are written.
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* file) {
  const auto real = next("fwrite", &fwrite);
  const int error = fault("fwrite", path_of(::fileno(file)));
  if (error == 0)
    return real(data, size, count, file);
  const std::size_t written = real(data, 1, size * count / 2, file);
  errno = error;
  return written / size;
}

int fflush(std::FILE* file) {
  const int error = file ? fault("fflush", path_of(::fileno(file))) : 0;
  if (error == 0)
    return next("fflush", &fflush)(file);
  errno = error;
  return EOF;
}

int fsync(int descriptor) {
  const int error = fault("fsync", path_of(descriptor));
  if (error == 0)
    return next("fsync", &fsync)(descriptor);
  errno = error;
  return -1;
}

/// As close(2) does it: the file is closed, and the error tells of data that is lost.
int fclose(std::FILE* file) {
  const int error = fault("fclose", path_of(::fileno(file)));
  const int result = next("fclose", &fclose)(file);
  if (error == 0)
    return result;
  errno = error;
  return EOF;
}

int rename(const char* from, const char* to) {
  const int error = fault("rename", from);
  if (error == 0)
    return next("rename", &rename)(from, to);
  errno = error;
  return -1;
}

} // extern "C"
