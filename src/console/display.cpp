#include "console/display.h"

#include "console/display_packets.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace vdbeam::cli {
namespace {

constexpr std::chrono::seconds retry_interval{1}, last_patience{2};
constexpr int poll_step = 100; // milliseconds
/// A packet says its length in 32 bits.
constexpr std::uint64_t most_pixels = 1'000'000'000;

struct HostAndPort {
  std::string host, port;
};

/// "localhost:14158", "[::1]:14158".
HostAndPort split_address(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  HostAndPort parts{address.substr(0, colon),
                    colon == std::string::npos ? "" : address.substr(colon + 1)};
  if (parts.host.size() > 1 && parts.host.front() == '[' && parts.host.back() == ']')
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  constexpr std::size_t most_digits = 5;
  constexpr int last_port = 65535;
  const bool number = !parts.port.empty() && parts.port.size() <= most_digits &&
                      parts.port.find_first_not_of("0123456789") == std::string::npos;
  if (parts.host.empty() || !number || std::stoi(parts.port) > last_port)
    throw InputError(one_line(fmt::format(
        "--display {}: must look like HOST:PORT, e.g. localhost:14158, tev's port", address)));
  return parts;
}

} // namespace

Display::Display(const std::string& address, std::function<void(const std::string&)> on_loss)
    : address_(address), on_loss_(std::move(on_loss)) {
  const HostAndPort parts = split_address(address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(parts.host.c_str(), parts.port.c_str(), &hints, &found))
    throw InputError(one_line(fmt::format("--display {}: the host {} is unknown ({})", address,
                                          parts.host, gai_strerror(error))));
  for (const addrinfo* entry = found; entry; entry = entry->ai_next) {
    const char* const bytes = reinterpret_cast<const char*>(entry->ai_addr);
    addresses_.emplace_back(bytes, bytes + entry->ai_addrlen);
  }
  freeaddrinfo(found);
  thread_ = std::thread([this] { run(); });
}

Display::~Display() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, last_patience, [this] { return failed_ || (!next_ && !sending_); });
    closing_ = true;
  }
  changed_.notify_all();
  thread_.join();
  disconnect();
}

void Display::show(const std::string& name, Image image) {
  if (static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height) >
      most_pixels)
    return;
  {
    const std::lock_guard lock(mutex_);
    next_ = Named{name, std::move(image)};
  }
  changed_.notify_all();
}

void Display::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return closing_ || next_; });
    if (closing_)
      return;
    Named shown = std::move(*next_);
    next_.reset();
    sending_ = true;
    lock.unlock();
    const bool sent = (socket_ >= 0 || connect_to_any()) && send(shown);
    if (!sent) {
      disconnect();
      if (on_loss_ && !failed_ && !closing_)
        on_loss_(
            fmt::format("note: no viewer at {} takes the image; vdbeam tries again", address_));
    }
    lock.lock();
    failed_ = !sent;
    if (!sent && !next_)
      next_ = std::move(shown); // until there is a newer one
    sending_ = false;
    changed_.notify_all();
    if (!sent)
      changed_.wait_for(lock, retry_interval, [this] { return closing_.load(); });
  }
}

/// Waits until the socket can be used. False where it cannot, and when the display is closed.
bool Display::ready(short event) const {
  for (;;) {
    pollfd wait{socket_, event, 0};
    const int count = poll(&wait, 1, poll_step);
    if (count > 0)
      return (wait.revents & (POLLERR | POLLHUP | POLLNVAL)) == 0;
    if (count < 0 && errno != EINTR)
      return false;
    if (closing_)
      return false;
  }
}

bool Display::connect_to_any() {
  for (const Address& address : addresses_) {
    const auto* const target = reinterpret_cast<const sockaddr*>(address.data());
    socket_ = ::socket(target->sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0)
      continue;
    int error = 0;
    socklen_t size = sizeof error;
    const bool begun = ::connect(socket_, target, static_cast<socklen_t>(address.size())) == 0 ||
                       errno == EINPROGRESS;
    if (begun && ready(POLLOUT) && getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size) == 0 &&
        error == 0)
      return true;
    disconnect();
  }
  return false;
}

bool Display::send_all(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (!ready(POLLOUT))
      return false;
    const ssize_t sent =
        ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0)
      done += static_cast<std::size_t>(sent);
    else if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
      return false;
  }
  return true;
}

/// Creates the image where the viewer does not have it, then sends channel after channel.
bool Display::send(const Named& shown) {
  const std::string create = create_packet(shown.name, shown.image);
  if (create != created_) {
    if (!send_all(create))
      return false;
    created_ = create;
  }
  for (const ImageChannel& channel : shown.image.channels)
    if (!send_all(update_packet(shown.name, shown.image, channel)))
      return false;
  return true;
}

void Display::disconnect() {
  if (socket_ >= 0)
    ::close(socket_);
  socket_ = -1;
  created_.clear();
}

} // namespace vdbeam::cli
