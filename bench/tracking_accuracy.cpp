// Where a tag's corners are found, against where they are: ours beside its peers, on the same frames. docs/tracking.md explains
// the tables. Everything is measured and printed, or the parts that are named; --csv FOLDER also writes the ladders there.
#include <algorithm>
#include <cstdio>
#include <opencv2/core/utility.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/experiments.hpp"
#include "catchlight/error.hpp"

namespace {

using namespace catchlight;

constexpr const char* kUsage = "usage: tracking_accuracy [--csv FOLDER] [ladders] [jitter] [branches] [plates]";

void run(std::vector<std::string> arguments) {
  std::optional<std::filesystem::path> csv_folder;
  if (!arguments.empty() && arguments[0] == "--csv") {
    if (arguments.size() < 2) throw UsageError(kUsage);
    csv_folder = arguments[1];
    std::filesystem::create_directories(*csv_folder);
    arguments.erase(arguments.begin(), arguments.begin() + 2);
  }
  const std::vector<std::string> parts{"ladders", "jitter", "branches", "plates"};
  for (const std::string& argument : arguments)
    if (std::find(parts.begin(), parts.end(), argument) == parts.end()) throw UsageError(kUsage);
  const auto wanted = [&](const std::string& part) {
    return arguments.empty() || std::find(arguments.begin(), arguments.end(), part) != arguments.end();
  };
  if (wanted("ladders")) tracking::measure_ladders(csv_folder);
  if (wanted("jitter")) tracking::measure_jitter();
  if (wanted("branches")) tracking::measure_branches();
  if (wanted("plates"))
    tracking::measure_plates(std::filesystem::path(CATCHLIGHT_SOURCE_DIR).parent_path() / "shared/groundtruth");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    cv::setNumThreads(1);
    run({argv + 1, argv + argc});
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
