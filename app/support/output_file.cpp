#include "app/support/output_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "catchlight/error.hpp"

namespace catchlight::app {

namespace fs = std::filesystem;

PendingFile pending_output(const std::string& path, bool overwrite) {
  const fs::path folder = fs::path(path).parent_path();
  if (path.empty()) throw UsageError("the name of the output file is empty");
  if (fs::is_directory(path)) throw UsageError(path + ": is a folder; give the name of a file to write");
  if (!folder.empty() && !fs::is_directory(folder))
    throw Error(path + ": there is no folder " + folder.string() + "; make it first, or choose another output");
  if (fs::exists(path) && !fs::is_regular_file(path))
    throw UsageError(path + ": is a device or a pipe, which a file would replace; choose another output");
  if (!overwrite && fs::exists(path))
    throw UsageError(path + ": exists already; pass -y to overwrite it, or choose another output");
  return PendingFile(path);
}

void check_output_path(const std::string& path, bool overwrite) {
  pending_output(path, overwrite);
}

void refuse_same_file(const std::string& output, const std::string& input) {
  std::error_code ignored;
  if (fs::equivalent(output, input, ignored))
    throw UsageError("'" + output + "' is the input itself; choose another name for the output");
}

void refuse_shared_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  const auto place = [](const std::string& path) { return fs::weakly_canonical(fs::absolute(path)); };
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (output->empty() || *output == "-") continue;
    for (const std::string& input : inputs) refuse_same_file(*output, input);
    const auto same = [&](const std::string& other) { return !other.empty() && place(other) == place(*output); };
    if (std::any_of(outputs.begin(), output, same))
      throw UsageError(*output + ": is named for two outputs; choose another name for one of them");
  }
}

void make_output_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder + ": cannot be made: " + error.message() + "; choose another folder");
}

void write_text_file(const std::string& path, std::string_view text, bool overwrite) {
  PendingFile pending = pending_output(path, overwrite);
  std::ofstream file(pending.pending_path(), std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) throw Error(path + ": cannot be written; is the disk full?");
  pending.commit();
}

}  // namespace catchlight::app
