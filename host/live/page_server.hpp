#pragma once
// The live page and what it reads, over HTTP. README.md has the addresses.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/live/pending_request.hpp"

namespace strainfinger::live {

/// page.html.
std::string_view builtInPage();

struct PageServerOptions {
  std::string address = "127.0.0.1";  ///< of the interface it listens on, IPv4 or IPv6
  int port = 8080;                    ///< 0: any that is free
  std::string token;                  ///< commands must have it; empty: they need none
  std::string shapeJson = "{}";       ///< what /finger answers
};

/// Whether only this machine reaches the address.
bool isLocalAddress(std::string_view address);

/// Serves in threads of its own from construction to destruction; publish() never waits. A request that is
/// not whole after 2 s, or an answer of which nothing is taken for 2 s, costs a thread of many for that time.
/// A reader of events that takes a little of them now and then keeps its thread, and kMostReaders is their
/// limit.
class PageServer {
 public:
  /// Readers of events at a time; those beyond are told to come again (503).
  static constexpr int kMostReaders = 64;

  /// Throws Failure(kFailure) when it cannot listen there.
  explicit PageServer(const PageServerOptions& options);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  int port() const;

  /// Whether anybody reads events or has asked for the state since the last call.
  bool isRead();
  /// To all that read events, a JSON object.
  void publish(const std::string& json);

  /// Fingers to be tared, asked for since the last call; each wants an answer().
  std::vector<std::uint8_t> takeTares();
  void answer(const Outcome& outcome);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strainfinger::live
