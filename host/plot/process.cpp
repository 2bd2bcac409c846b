#include "host/plot/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "host/base/failure.hpp"

namespace strainfinger::plot {
namespace {

[[noreturn]] void fail(const std::string& message) { throw Failure(ExitCode::kFailure, message); }

/// What becomes of the child's files: stderr to `errors`, stdin empty, stdout (ours may be data) to stderr
/// too.
class Redirections {
 public:
  Redirections(const std::string& folder, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
  }
  ~Redirections() { posix_spawn_file_actions_destroy(&actions_); }
  Redirections(const Redirections&) = delete;
  Redirections& operator=(const Redirections&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

std::vector<char*> argumentsOf(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

/// Everything up to the end of the pipe, which is closed then.
std::string drain(int pipe) {
  std::string text;
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t count = ::read(pipe, block.data(), block.size());
    if (count > 0) text.append(block.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) break;
  }
  ::close(pipe);
  return text;
}

int waitFor(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  return status;
}

}  // namespace

void runIn(const std::string& folder, const std::vector<std::string>& command, const std::string& package) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) fail(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  pid_t child = 0;
  const Redirections files(folder, pipe[1]);
  const int error =
      ::posix_spawnp(&child, command[0].c_str(), files.get(), nullptr, argumentsOf(command).data(), environ);
  ::close(pipe[1]);
  const std::string complaint = drain(pipe[0]);
  if (error == ENOENT) fail(fmt::format("{} is not installed: apt install {}", command[0], package));
  if (error != 0) fail(fmt::format("cannot start {}: {}", command[0], std::strerror(error)));
  if (waitFor(child) != 0) fail(fmt::format("{} failed:\n{}", fmt::join(command, " "), complaint));
}

}  // namespace strainfinger::plot
