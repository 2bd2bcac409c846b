#include "host/system/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "host/base/failure.hpp"

namespace strainfinger::system {
namespace {

[[noreturn]] void fail(const std::string& message) { throw Failure(ExitCode::kFailure, message); }

/// A descriptor, closed at the end.
class Descriptor {
 public:
  Descriptor(int number, const char* what) : number_(number) {
    if (number < 0) fail(fmt::format("cannot make {}: {}", what, std::strerror(errno)));
  }
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

/// What becomes of the child's files; its stdin is empty.
class Redirections {
 public:
  Redirections(const std::string& folder, int output, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
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

/// Everything up to the end of a pipe or a file.
std::string drain(int file) {
  std::string text;
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t count = ::read(file, block.data(), block.size());
    if (count > 0) text.append(block.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

int waitFor(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  return status;
}

}  // namespace

std::string runIn(const std::string& folder, const std::vector<std::string>& command,
                  const std::string& package) {
  std::array<int, 2> pipe{-1, -1};
  static_cast<void>(::pipe2(pipe.data(), O_CLOEXEC));
  Descriptor ours(pipe[0], "a pipe"), its(pipe[1], "a pipe");
  // In memory: two pipes would have to be read by turns.
  const Descriptor errors(::memfd_create("stderr", MFD_CLOEXEC), "a file in memory");
  pid_t child = 0;
  const Redirections files(folder, its.number(), errors.number());
  const int error =
      ::posix_spawnp(&child, command[0].c_str(), files.get(), nullptr, argumentsOf(command).data(), environ);
  its.close();
  if (error == ENOENT) fail(fmt::format("{} is not installed: apt install {}", command[0], package));
  if (error != 0) fail(fmt::format("cannot start {}: {}", command[0], std::strerror(error)));
  std::string output = drain(ours.number());
  if (waitFor(child) == 0) return output;
  ::lseek(errors.number(), 0, SEEK_SET);
  fail(fmt::format("{} failed:\n{}", fmt::join(command, " "), drain(errors.number())));
}

}  // namespace strainfinger::system
