#pragma once
// The connection of one client, as the HTTP library reads and writes it: a request has an end, in time and
// size.

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <string>

namespace strainfinger::live {

/// The library waits for each byte anew and takes any number of header lines: a client could keep a thread
/// for ever by sending little, and fill the memory by sending much.
class ClientStream final : public httplib::Stream {
 public:
  struct Limit {
    std::chrono::milliseconds request;  ///< from now on, for all of the request to come
    std::chrono::milliseconds write;    ///< for room for the next bytes of the answer
    std::size_t request_bytes;
  };

  /// The socket remains the caller's.
  ClientStream(int socket, const Limit& limit);

  bool is_readable() const override;
  /// False too once the client has gone.
  bool is_writable() const override;
  /// As many bytes as there are, at least one; 0: the client has ended its request; -1: there are none, or
  /// more than the limit.
  ssize_t read(char* to, std::size_t size) override;
  ssize_t write(const char* from, std::size_t size) override;
  socket_t socket() const override { return socket_; }

  /// Nobody asks who the client is.
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}

 private:
  ssize_t fill();

  int socket_;
  Limit limit_;
  std::chrono::steady_clock::time_point end_;  ///< of the request
  std::size_t received_bytes_ = 0;
  std::array<char, 4096> buffer_{};  ///< the library asks for single bytes
  std::size_t begin_ = 0;            ///< of what was received and not read
  std::size_t filled_ = 0;
};

}  // namespace strainfinger::live
