#include "app/window/panels/background_run.hpp"

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/window/editing/overlay_command.hpp"

namespace catchlight::app {

BackgroundRun::BackgroundRun(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{std::filesystem::read_symlink("/proc/self/exe").string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  thread_ = std::jthread([this, command = shell_text(words) + " 2>&1"] { run(command); });
}

void BackgroundRun::run(const std::string& command) {
  std::FILE* said = popen(command.c_str(), "r");
  if (said) {
    std::string line;
    for (int c = std::fgetc(said); c != EOF; c = std::fgetc(said)) {
      if (c != '\n' && c != '\r') {
        line += static_cast<char>(c);
        continue;
      }
      const std::lock_guard lock(mutex_);
      if (!line.empty()) line_ = std::exchange(line, "");
    }
    const int status = pclose(said);
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  is_over_ = true;
}

std::string BackgroundRun::last_line() const {
  const std::lock_guard lock(mutex_);
  return line_;
}

}  // namespace catchlight::app
