#pragma once

#include "vdbeam/image.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace vdbeam::cli {

/// Shows images in the viewer tev (https://github.com/Tom94/tev), or in another program that speaks
/// its protocol: over TCP, by a thread of its own, since it waits for a network and computes
/// nothing. Who renders never waits: an image that is not sent yet is replaced by the next one. The
/// connection is made when there is an image, and made again where it was lost.
class Display {
public:
  /// `address`: HOST:PORT. Throws InputError for anything else, and for an unknown host. `on_loss`,
  /// unless it is empty, is called by the thread, with a line for the user, where no viewer takes
  /// an image and the one before was sent.
  explicit Display(const std::string& address,
                   std::function<void(const std::string&)> on_loss = {});
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  /// Gives the last image some time to be sent.
  ~Display();

  /// Shows an image under a name, with the channels that it has.
  void show(const std::string& name, Image image);

private:
  struct Named {
    std::string name;
    Image image;
  };
  using Address = std::vector<char>; ///< a sockaddr

  void run();
  bool connect_to_any();
  bool send(const Named& shown);
  bool send_all(const std::string& bytes);
  bool ready(short event) const;
  void disconnect();

  std::string address_; ///< as it was given
  std::function<void(const std::string&)> on_loss_;
  std::vector<Address> addresses_;
  int socket_ = -1;
  std::string created_; ///< name and layout of the image that the viewer has from this connection
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Named> next_;
  bool sending_ = false, failed_ = false;
  std::atomic<bool> closing_ = false;
  std::thread thread_; ///< the last member: it uses the others
};

} // namespace vdbeam::cli
