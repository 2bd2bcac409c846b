#include "host/live/page_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(PageServer) {
  live::PageServer server_{
      live::PageServerOptions{.address = "127.0.0.1", .port = 0, .token = "", .shapeJson = "{}"}};

  /// To the end of the connection.
  std::string answerTo(const std::string& request) const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server_.port()));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    LONGS_EQUAL(0, connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address));
    LONGS_EQUAL(request.size(), write(socket, request.data(), request.size()));
    std::string answer;
    std::array<char, 1000> block{};
    for (ssize_t count = 0; (count = read(socket, block.data(), block.size())) > 0;)
      answer.append(block.data(), static_cast<std::size_t>(count));
    close(socket);
    return answer;
  }
};

TEST(PageServer, ThatNothingCameInTimeIsNotToldAsItsEnd) {
  for (const char* request :
       {"GET /state HTTP/1.1\r\nHost: localhost\r\n\r\n",
        "POST /fingers/1/tare HTTP/1.1\r\nHost: localhost\r\nX-Strainfinger: -\r\n\r\n"}) {
    const std::string answer = answerTo(request);
    STRCMP_CONTAINS("HTTP/1.1 504 ", answer.c_str());
    STRCMP_CONTAINS("There was no answer within 2 s: ask again.", answer.c_str());
  }
}
