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

constexpr std::size_t kLargest = std::size_t{1} << 28;  // bytes

/// Runs a script on a terminal of gnuplot; returns the picture.
std::string plotted(const std::string& script, const std::string& terminal) {
  const ScratchFolder folder;
  const fs::path script_file = folder.path() / "plot.gp";
  const fs::path picture = folder.path() / "picture";
  std::ofstream(script_file) << fmt::format("set terminal {}\nset output '{}'\nset encoding utf8\n",
                                            terminal, picture.string())
                             << script << "\nunset output\n";
  const std::string command = fmt::format("gnuplot '{}' >/dev/null 2>&1", script_file.string());
  if (std::system(command.c_str()) != 0) {
    throw InputError("gnuplot failed: pictures need the program gnuplot (Debian: gnuplot-nox)");
  }
  return files::read_file(picture, kLargest);
}

/// Without what stands between two marks, these included; as it was where they do not.
std::string without(std::string text, const std::string& open, const std::string& close) {
  const std::size_t begin = text.find(open);
  const std::size_t end = text.find(close, begin);
  if (begin != std::string::npos && end != std::string::npos) {
    text.erase(begin, end + close.size() - begin);
  }
  return text;
}

/// Without the name and the version of gnuplot, which browsers show at every place of the picture.
std::string without_its_maker(std::string svg) {
  return without(without(std::move(svg), "<title>Gnuplot", "</title>"), "<desc>Produced",
                 "</desc>");
}

}  // namespace

std::string plot_svg(const std::string& script, int width, int height) {
  const std::string svg = without_its_maker(plotted(
      script,
      fmt::format("svg size {},{} font 'sans-serif,13' background '#ffffff'", width, height)));
  const std::size_t begin = svg.find("<svg");
  return begin == std::string::npos ? svg : svg.substr(begin);
}

std::string plot_png(const std::string& script, int width, int height) {
  return plotted(
      script,
      fmt::format("pngcairo size {},{} font 'sans-serif,13' background '#ffffff'", width, height));
}

}  // namespace flexcomp::report
