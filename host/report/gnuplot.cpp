#include "report/gnuplot.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::report {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes when it is done with.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "flexcomp-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw InputError(fmt::format("{}: cannot make a temporary folder", name));
    }
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

std::string plot_svg(const std::string& script, int width, int height) {
  const ScratchFolder folder;
  const fs::path script_file = folder.path() / "plot.gp";
  const fs::path picture = folder.path() / "plot.svg";
  std::ofstream(script_file) << fmt::format(
                                    "set terminal svg size {},{} font 'sans-serif,13' "
                                    "background '#ffffff'\nset output '{}'\nset encoding utf8\n",
                                    width, height, picture.string())
                             << script << "\nunset output\n";
  const std::string command = fmt::format("gnuplot '{}' >/dev/null 2>&1", script_file.string());
  if (std::system(command.c_str()) != 0) {
    throw InputError("gnuplot failed: pictures need the program gnuplot (Debian: gnuplot-nox)");
  }
  const std::string svg = files::read_text(picture);
  const std::size_t begin = svg.find("<svg");
  return begin == std::string::npos ? svg : svg.substr(begin);
}

}  // namespace flexcomp::report
