#pragma once

#include "machine/atomic_file.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/image.h"

#include <ImfHeader.h>
#include <ImfIO.h>
#include <fmt/format.h>

#include <new>

namespace vdbeam {

/// OpenEXR's way into an AtomicFile.
class AtomicStream : public Imf::OStream {
public:
  explicit AtomicStream(AtomicFile& file) : OStream(file.path().c_str()), file_(file) {}
  void write(const char bytes[], int count) override {
    file_.write(bytes, static_cast<std::size_t>(count));
  }
  std::uint64_t tellp() override { return file_.position(); }
  void seekp(std::uint64_t position) override { file_.seek(position); }

private:
  AtomicFile& file_;
};

/// A ZIP-compressed header with the image's windows and attributes, without channels. Throws
/// FrameError for attributes that cannot be stored; `path` is for its message.
Imf::Header exr_header(const Image& image, const std::string& path);

/// As the public write_exr.
void write_exr(const Image& image, const std::string& path, Links links,
               Synced synced = Synced::yes);

/// The other way: text, numbers and matrices of a header into the image's maps.
void copy_attributes(const Imf::Header& header, Image& image);

/// Refuses a header whose attributes are longer than the file: OpenEXR would allocate the memory
/// before it finds the file too short. Also what must stand before OpenEXR opens a path by itself:
/// throws InputError for what is not a regular file.
void check_attribute_sizes(const std::string& path);

/// Runs OpenEXR and turns its errors into a `Failure` of one line; where memory runs out, into a
/// FrameError.
template <class Failure, class Body>
auto with_exr(const std::string& path, const char* problem, const Body& body) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw FrameError(
        path + ": there is not enough memory for its pixels; free some, or use a smaller image");
  } catch (const std::exception& error) {
    throw Failure(fmt::format("{}: {}: {}", path, problem, one_line(error.what())));
  }
}

} // namespace vdbeam
