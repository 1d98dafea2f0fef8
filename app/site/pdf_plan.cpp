#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/common/spawn_attributes.hpp"
#include "app/site/floor_plan.hpp"
#include "maps/input_error.hpp"
#include "maps/picture.hpp"

// By poppler's program and not by its library: what a stranger's PDF does to the reader happens in another
// process with limits, and nobody who never reads a plan needs poppler.
namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr int not_found = 127;

/// Removed with all in it at the end.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (fs::temp_directory_path() / "lodestar-plan-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw InputError(name, 0, std::strerror(errno), "a temporary folder");
    path_ = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void limit(int resource, rlim_t most) {
  const rlimit limits{most, most};
  (void)::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// In the child, where only what is safe after fork may be called.
[[noreturn]] void become(char* const* words) {
  constexpr rlim_t seconds = 60;
  constexpr rlim_t memory = 4ULL << 30U;
  constexpr rlim_t picture = 1ULL << 30U;
  limit(RLIMIT_CPU, seconds);
  limit(RLIMIT_AS, memory);
  limit(RLIMIT_FSIZE, picture);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int stream = 0; stream <= 2; ++stream) (void)::dup2(nowhere, stream);
  ::execvp(words[0], words);
  ::_exit(not_found);
}

/// The exit code, or -1 when a signal ended it.
int run(std::vector<std::string> words) {
  const std::vector<char*> pointers = argument_pointers(words);
  const pid_t child = ::fork();
  if (child < 0) throw InputError(fmt::format("{}: {}", words[0], std::strerror(errno)));
  if (child == 0) become(pointers.data());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

cv::Mat read_pdf_page(const fs::path& file) {
  const WorkFolder folder;
  const fs::path page = folder.path() / "page";
  const int code = run({"pdftoppm", "-gray", "-r", "150", "-f", "1", "-l", "1", "-singlefile",
                        fs::absolute(file).string(), page.string()});
  if (code == not_found)
    throw InputError(file, 0, "no program pdftoppm to read it with", "it: apt install poppler-utils");
  try {
    if (code == 0) return gray_picture_in(page.string() + ".pgm");
  } catch (const PictureError&) {  // it drew nothing
  }
  throw InputError(file, 0, fmt::format("no page that pdftoppm can draw (exit code {})", code), "a PDF file");
}

}  // namespace lodestar
