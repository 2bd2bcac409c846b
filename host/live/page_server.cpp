#include "host/live/page_server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <regex>
#include <thread>

#include "common/frame_layout.hpp"
#include "host/base/failure.hpp"
#include "host/base/parse_number.hpp"
#include "host/base/table_writer.hpp"
#include "host/live/client_stream.hpp"
#include "host/live/command_desk.hpp"
#include "host/live/event_hub.hpp"

namespace strainfinger::live {
namespace {

using namespace std::chrono_literals;

/// Beside the readers of events there are threads for short requests.
constexpr int kThreads = PageServer::kMostReaders + 32;
/// A client whose request is not whole after this time, or that takes nothing of its answer for as long, is
/// left.
constexpr auto kPatience = 2s;
constexpr std::size_t kLargestBody_bytes = 1024;
/// Head and body: browsers send some 1 KiB.
constexpr std::size_t kLargestRequest_bytes = 16384;
/// Clients that are not accepted yet: the library has room for 5, and the next ones of a burst wait a second.
constexpr int kBacklog = 128;
/// A reader that stalls finds this much of old events at most when it goes on.
constexpr int kSendBuffer_bytes = 32768;
/// How often a reader's thread looks whether it is to end.
constexpr auto kLookUp = 250ms;
/// Longer than a PendingRequest waits.
constexpr auto kAnswerWithin = 2s;

/// Other pages cannot send this header here: browsers ask for leave first, and get none.
constexpr const char* kCommandHeader = "X-Strainfinger";

void setSocketOptions(socket_t socket) {
  const int on = 1;
  // Not the library's default, SO_REUSEPORT: with that two programs share a port and each gets half the
  // readers.
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBuffer_bytes, sizeof kSendBuffer_bytes);
}

/// "127.0.0.1" of "127.0.0.1:8080", "[::1]" of "[::1]:8080".
std::string hostName(const std::string& host) {
  const std::size_t end = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
  return host.substr(0, end);
}

/// A page of somebody else whose name was made to mean this machine sends its own name as Host.
bool isLocalHost(const std::string& host) {
  const std::string name = hostName(host);
  return name == "localhost" || name == "[::1]" || isLocalAddress(name);
}

constexpr std::array<std::string_view, 4> kPages{"/", "/finger", "/state", "/events"};
constexpr const char* kTarePath = R"(/fingers/(\d{1,2})/tare)";

/// Takes as long for any text of the same length.
bool areSame(const std::string& one, const std::string& other) {
  if (one.size() != other.size()) return false;
  bool differ = false;
  for (std::size_t i = 0; i < one.size(); ++i) differ |= one[i] != other[i];
  return !differ;
}

void say(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(R"({"text":)" + jsonString(text) + "}\n", "application/json");
}

/// What was wrong with a request of which the library says only the status.
std::string whatWasWrong(int status) {
  switch (status) {
    case 400:
      return fmt::format(
          "The request was not understood, is larger than {} KiB, or was not whole after {} s.",
          kLargestRequest_bytes / 1024, kPatience / 1s);
    case 413:
      return fmt::format("The request's body is larger than {} bytes: none is needed.", kLargestBody_bytes);
    case 414:
      return "The request's address is too long.";
    case 416:
      return "The request's Range was not understood: leave it out, answers are whole.";
    default:
      return "The program could not answer this request: ask again.";
  }
}

bool isKnown(const httplib::Request& request) {
  static const std::regex kTare(kTarePath);
  if (request.method == "POST") return std::regex_match(request.path, kTare);
  return (request.method == "GET" || request.method == "HEAD") &&
         std::ranges::find(kPages, request.path) != kPages.end();
}

/// Of what the system says against listening there, as the library doesn't; 0: nothing, now.
int errorOfBinding(const addrinfo& place) {
  const int socket = ::socket(place.ai_family, place.ai_socktype, place.ai_protocol);
  if (socket < 0) return errno;
  setSocketOptions(socket);
  const int error = ::bind(socket, place.ai_addr, place.ai_addrlen) == 0 ? 0 : errno;
  ::close(socket);
  return error;
}

/// Why it cannot be listened there, and what to do.
std::string whyNot(const std::string& address, int port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  if (const int unknown = ::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found);
      unknown != 0)
    return fmt::format("this is no address: {}; `ip address` shows those of this machine",
                       ::gai_strerror(unknown));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> places(found, &::freeaddrinfo);
  switch (const int error = errorOfBinding(*places)) {
    case EADDRINUSE:
      return "another program does (--port takes another, `ss -ltnp` shows which)";
    case EACCES:
      return "ports below 1024 are for root: --port takes another";
    case EADDRNOTAVAIL:
      return "this machine has no such address: `ip address` shows those that it has";
    default:
      return error == 0 ? "try again" : std::strerror(error);
  }
}

/// The library's server, with limits that it has none of.
class LimitedServer : public httplib::Server {
 public:
  /// Of a server that is bound.
  void lengthenQueue() { ::listen(svr_sock_, kBacklog); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    ClientStream client(socket,
                        {.request = kPatience, .write = kPatience, .request_bytes = kLargestRequest_bytes});
    bool isClosed = false;
    // Whole: of many ranges each would be as large as the page.
    const bool isAnswered =
        process_request(client, true, isClosed, [](httplib::Request& request) { request.ranges.clear(); });
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return isAnswered;
  }
};

}  // namespace

bool isLocalAddress(std::string_view address) {
  const bool isNumbers =
      address.find_first_not_of("0123456789.") == address.npos;  // not 127.somebody.example
  return address == "localhost" || address == "::1" || (isNumbers && address.starts_with("127."));
}

class PageServer::Impl {
 public:
  explicit Impl(const PageServerOptions& options) : options_(options) {
    setUp();
    addPages();
    addEvents();
    addCommands();
    bind();
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::sleep_for(1ms);
  }

  ~Impl() {
    hub_.close();
    server_.stop();
    thread_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int port() const { return port_; }
  bool isRead() { return readers_ > 0 || wanted_.exchange(false); }
  EventHub& hub() { return hub_; }
  CommandDesk& tares() { return tares_; }

 private:
  void setUp() {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_payload_max_length(kLargestBody_bytes);
    server_.set_tcp_nodelay(true);
    server_.set_socket_options(setSocketOptions);
    server_.set_default_headers(
        {{"Cache-Control", "no-store"},
         {"X-Content-Type-Options", "nosniff"},
         {"Referrer-Policy", "no-referrer"},
         {"Content-Security-Policy",
          "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
          "connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'"}});
    server_.set_error_handler([](const httplib::Request& request, httplib::Response& response) {
      if (!response.body.empty()) return;
      // the library says 400 of a POST that nothing answers
      const bool isNotKnown =
          (response.status == 404 || response.status == 400) && !request.path.empty() && !isKnown(request);
      if (!isNotKnown) return say(response, response.status, whatWasWrong(response.status));
      say(response, 404,
          fmt::format("{} {} is not known: GET {}; POST /fingers/NODE/tare.", request.method, request.path,
                      fmt::join(kPages, ", ")));
    });
    if (isLocalAddress(options_.address))
      server_.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
        if (isLocalHost(request.get_header_value("Host"))) return httplib::Server::HandlerResponse::Unhandled;
        say(response, 403, "Only by the address that `serve` printed.");
        return httplib::Server::HandlerResponse::Handled;
      });
  }

  void addPages() {
    server_.Get("/", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(builtInPage().data(), builtInPage().size(), "text/html; charset=utf-8");
    });
    server_.Get("/finger", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(options_.shapeJson, "application/json");
    });
    server_.Get("/state", [this](const httplib::Request&, httplib::Response& response) {
      const EventHub::Event before = hub_.next(0, 0ms);
      wanted_ = true;
      const EventHub::Event event = hub_.next(before.number, kAnswerWithin);
      if (event.text) return response.set_content(*event.text + "\n", "application/json");
      sayWhyNothing(response);
    });
  }

  void sayWhyNothing(httplib::Response& response) {
    if (hub_.isClosed()) return say(response, 503, "The program is ending.");
    say(response, 504, fmt::format("There was no answer within {} s: ask again.", kAnswerWithin / 1s));
  }

  void addEvents() {
    server_.Get("/events", [this](const httplib::Request&, httplib::Response& response) {
      if (++readers_ > kMostReaders) {
        --readers_;
        response.set_header("Retry-After", "5");
        return say(response, 503, "Too many readers: come again later.");
      }
      auto last = std::make_shared<std::uint64_t>(hub_.next(0, 0ms).number);
      response.set_chunked_content_provider(
          "text/event-stream",
          [this, last](std::size_t, httplib::DataSink& sink) { return sendNext(*last, sink); },
          [this](bool) { --readers_; });
    });
  }

  /// False ends the stream.
  bool sendNext(std::uint64_t& last, httplib::DataSink& sink) {
    const EventHub::Event event = hub_.next(last, kLookUp);
    if (hub_.isClosed()) return false;
    if (!event.text) return true;
    last = event.number;
    const std::string text = fmt::format("id: {}\ndata: {}\n\n", event.number, *event.text);
    return sink.write(text.data(), text.size());
  }

  void addCommands() {
    server_.Post(kTarePath, [this](const httplib::Request& request, httplib::Response& response,
                                   const httplib::ContentReader& body) {
      if (passOver(request, body)) tare(request, response);
    });
  }

  /// False: what follows is no body, or too large, and the library has said so. A request that tells no
  /// length has none (RFC 9112, 6.3); the library would refuse it.
  static bool passOver(const httplib::Request& request, const httplib::ContentReader& body) {
    const bool hasBody = request.has_header("Content-Length") || request.has_header("Transfer-Encoding");
    return !hasBody || body([](const char*, std::size_t) { return true; });
  }

  void tare(const httplib::Request& request, httplib::Response& response) {
    if (!mayCommand(request)) return say(response, 403, forbidden());
    const int node = parseNumber<int>(request.matches[1].str()).value_or(0);
    if (node < kFirstNode || node > kLastNode)
      return say(response, 404,
                 fmt::format("There is no node {}: they are {} to {}.", node, kFirstNode, kLastNode));
    const auto outcome = tares_.ask(static_cast<std::uint8_t>(node), kAnswerWithin);
    if (!outcome) return sayWhyNothing(response);
    say(response, outcome->isDone ? 200 : 409, outcome->text);
  }

  bool mayCommand(const httplib::Request& request) const {
    if (!request.has_header(kCommandHeader)) return false;
    return options_.token.empty() || areSame(request.get_header_value(kCommandHeader), options_.token);
  }

  std::string forbidden() const {
    return fmt::format("A command needs the header {}: {}.", kCommandHeader,
                       options_.token.empty() ? "anything" : "the token that `serve` printed");
  }

  void bind() {
    const std::string& address = options_.address;
    port_ = options_.port;
    if (port_ == 0)
      port_ = server_.bind_to_any_port(address);
    else if (!server_.bind_to_port(address, port_))
      port_ = -1;
    if (port_ < 0)
      throw Failure(ExitCode::kFailure, fmt::format("cannot listen on {} port {}: {}", address, options_.port,
                                                    whyNot(address, options_.port)));
    server_.lengthenQueue();
  }

  PageServerOptions options_;
  EventHub hub_;
  CommandDesk tares_;
  std::atomic<int> readers_ = 0;
  std::atomic<bool> wanted_ = false;
  LimitedServer server_;
  int port_ = 0;
  std::thread thread_;
};

PageServer::PageServer(const PageServerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
PageServer::~PageServer() = default;

int PageServer::port() const { return impl_->port(); }
bool PageServer::isRead() { return impl_->isRead(); }
void PageServer::publish(const std::string& json) { impl_->hub().publish(json); }
std::vector<std::uint8_t> PageServer::takeTares() { return impl_->tares().takeAsked(); }
void PageServer::answer(const Outcome& outcome) { impl_->tares().answer(outcome); }

}  // namespace strainfinger::live
