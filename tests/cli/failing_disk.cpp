// Preloaded into vdbeam by failing_disk_test.py and tools/attack.
// VDBEAM_TEST_FAULT, "FUNCTION ERRNO WORD", lets one function of the C library fail on output
// files, as a full disk or a lost network mount would: files whose names hold WORD and end in
// ".tmp". An ERRNO of -1 makes the call say so on stderr and never return. VDBEAM_TEST_KILL,
// "N FOLDER", kills the process before the N-th call that concerns a file in FOLDER;
// VDBEAM_TEST_CALLS names a file that lists those calls.
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
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

/// What is killed is the program, not the children that it forks.
const pid_t program = ::getpid();
std::atomic<int> calls{0};

std::string absolute(const std::string& path) {
  char folder[PATH_MAX] = "";
  if (path.empty() || path[0] == '/' || !::getcwd(folder, sizeof folder))
    return path;
  return std::string(folder) + '/' + path;
}

void list_call(const char* function) {
  const char* list = std::getenv("VDBEAM_TEST_CALLS");
  if (!list || !*list)
    return;
  const int descriptor =
      next("open", &::open)(list, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const std::string line = std::string(function) + '\n';
  if (::write(descriptor, line.data(), line.size()) < 0)
    std::abort();
  next("close", &::close)(descriptor);
}

/// Dies where this call's turn has come.
void note_call(const char* function, const std::string& path) {
  const char* wanted = std::getenv("VDBEAM_TEST_KILL");
  char folder[PATH_MAX] = "";
  int number = 0;
  static_assert(PATH_MAX == 4096);
  if (!wanted || ::getpid() != program || std::sscanf(wanted, "%d %4095s", &number, folder) != 2 ||
      absolute(path).rfind(folder, 0) != 0)
    return;
  list_call(function);
  if (++calls == number)
    std::raise(SIGKILL);
}

void note_call(const char* function, int descriptor) {
  if (std::getenv("VDBEAM_TEST_KILL"))
    note_call(function, path_of(descriptor));
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if (flags & O_CREAT)
    note_call("open", std::string(path));
  if (const int error = fault("open", path)) {
    errno = error;
    return -1;
  }
  return next("open", &open)(path, flags, mode);
}

/// The stream's own write(2) cannot be replaced; half of the bytes are written.
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* file) {
  const auto real = next("fwrite", &fwrite);
  note_call("fwrite", ::fileno(file));
  const int error = fault("fwrite", path_of(::fileno(file)));
  if (error == 0)
    return real(data, size, count, file);
  const std::size_t written = real(data, 1, size * count / 2, file);
  errno = error;
  return written / size;
}

int fflush(std::FILE* file) {
  if (file)
    note_call("fflush", ::fileno(file));
  const int error = file ? fault("fflush", path_of(::fileno(file))) : 0;
  if (error == 0)
    return next("fflush", &fflush)(file);
  errno = error;
  return EOF;
}

int fsync(int descriptor) {
  note_call("fsync", descriptor);
  const int error = fault("fsync", path_of(descriptor));
  if (error == 0)
    return next("fsync", &fsync)(descriptor);
  errno = error;
  return -1;
}

/// As close(2) does it: the file is closed, and the error reports lost data.
int fclose(std::FILE* file) {
  note_call("fclose", ::fileno(file));
  const int error = fault("fclose", path_of(::fileno(file)));
  const int result = next("fclose", &fclose)(file);
  if (error == 0)
    return result;
  errno = error;
  return EOF;
}

int rename(const char* from, const char* to) {
  note_call("rename", std::string(from));
  const int error = fault("rename", from);
  if (error == 0)
    return next("rename", &rename)(from, to);
  errno = error;
  return -1;
}

int close(int descriptor) {
  note_call("close", descriptor);
  return next("close", &close)(descriptor);
}

int flock(int descriptor, int operation) {
  note_call("flock", descriptor);
  return next("flock", &flock)(descriptor, operation);
}

int unlink(const char* path) {
  note_call("unlink", std::string(path));
  return next("unlink", &unlink)(path);
}

int remove(const char* path) {
  note_call("remove", std::string(path));
  return next("remove", &remove)(path);
}

} // extern "C"
