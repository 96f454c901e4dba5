#include "tests/support/run_command.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

/// Turns the child into the command: only what is safe between fork and exec, besides setenv, as tests have one thread.
[[noreturn]] void become(std::vector<char*>& arguments, const std::map<std::string, std::string>& environment,
                         const std::string& output, const std::string& error) {
  const auto redirect = [](int descriptor, const std::string& path) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || dup2(file, descriptor) < 0) _exit(126);
  };
  redirect(STDOUT_FILENO, output);
  redirect(STDERR_FILENO, error);
  // A cache folder of a test's own would have Mesa compile every shader anew.
  setenv("MESA_SHADER_CACHE_DIR", CATCHLIGHT_BINARY_DIR "/shader_cache", 0);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  execv(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

CommandResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          const std::map<std::string, std::string>& environment) {
  const TemporaryFolder folder;
  std::vector<std::string> all{program};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& argument : all) pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) become(pointers, environment, folder.path("stdout"), folder.path("stderr"));
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder.path("stdout")), read_text(folder.path("stderr"))};
}

CommandResult run_catchlight(const std::vector<std::string>& arguments, const std::map<std::string, std::string>& environment) {
  return run_program(CATCHLIGHT_EXECUTABLE, arguments, environment);
}

int count_of(std::string_view part, std::string_view text) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

}  // namespace catchlight::tests
