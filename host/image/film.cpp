#include "image/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "base/cleanup.hpp"
#include "base/output_file.hpp"
#include "base/spawn.hpp"
#include "base/write_file.hpp"
#include "image/file_format.hpp"
#include "image/row_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// How ffmpeg encodes a film.
struct FilmFormat {
  std::string extension;
  bool is_even;  ///< width and height are
  std::vector<std::string> encoder;
};

// Of what ffmpeg leaves open: R G B becomes Y Cb Cr by Rec.709, whose primaries are sRGB's, and the file says
// so. Its own choice, Rec.601 and nothing said, is shown in other colours by players that take films for
// Rec.709. What the file says is set on the frames: ffmpeg 7 forgets it where it is asked of the encoder
// alone.
const std::vector<std::string> kRec709{
    "-vf",
    "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_int,"
    "setparams=range=tv:colorspace=bt709:color_primaries=bt709:color_trc=iec61966-2-1",
    "-pix_fmt", "yuv420p"};

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The formats, at qualities where differences from the frames are hard to see. An mp4's index stands at its
/// start, so that it can be shown while it is loaded.
const std::vector<FilmFormat>& filmFormats() {
  static const std::vector<FilmFormat> formats{
      {"mp4", true, joined(kRec709, {"-c:v", "libx264", "-crf", "16", "-movflags", "+faststart"})},
      {"webm", false,
       joined(kRec709, {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-deadline", "good",
                        "-cpu-used", "4"})},
      {"webp", false, {"-c:v", "libwebp_anim", "-quality", "90", "-loop", "0"}}};
  return formats;
}

/// Null where it is no film's.
const FilmFormat* findFormat(const std::string& path, const std::string& format) {
  const std::string extension = formatName(path, format);
  const auto& all = filmFormats();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const FilmFormat& one) { return one.extension == extension; });
  return found == all.end() ? nullptr : &*found;
}

/// The descriptor that ffmpeg knows the film's file by.
constexpr int kFilmDescriptor = 3;

std::vector<std::string> ffmpegArguments(const FilmFormat& format, int width, int height, double rate) {
  std::vector<std::string> arguments{"ffmpeg",
                                     "-nostdin",
                                     "-hide_banner",
                                     "-loglevel",
                                     "error",
                                     "-xerror",
                                     "-y",
                                     "-f",
                                     "rawvideo",
                                     "-pixel_format",
                                     "rgb24",
                                     "-video_size",
                                     fmt::format("{}x{}", width, height),
                                     "-framerate",
                                     fmt::format("{}", rate),
                                     "-i",
                                     "pipe:0"};
  arguments = joined(std::move(arguments), format.encoder);
  return joined(std::move(arguments),
                {"-f", format.extension, fmt::format("/proc/self/fd/{}", kFilmDescriptor)});
}

}  // namespace

struct Film::State {
  /// A file descriptor that is closed at the end.
  struct Descriptor {
    int number = -1;
    explicit Descriptor(int of) : number(of) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    void close() {
      if (number >= 0) ::close(std::exchange(number, -1));
    }
  };

  State(const std::string& of_path, const FilmFormat& format, int width, int height, double rate)
      : path(of_path),
        row_bytes(std::size_t(width) * 3),
        file(of_path),
        messages(memfd_create("ffmpeg", MFD_CLOEXEC)) {
    start(format, width, height, rate);
  }
  ~State() {
    if (child <= 0) return;
    kill(child, SIGKILL);
    await();
  }

  std::string path;
  std::size_t row_bytes;
  OutputFile file;
  Descriptor messages;  ///< what ffmpeg says: a file in memory, which never makes it wait
  Descriptor input{-1};
  pid_t child = -1;
  std::optional<Cleanup> killing;  ///< of the child

  /// Frames go through a socket, because writing to a pipe that nobody reads any more ends the process.
  void start(const FilmFormat& format, int width, int height, double rate) {
    std::array<int, 2> ends{};
    if (messages.number < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw MachineError(fmt::format("{}: can't start ffmpeg: {}", path, systemReason()));
    const Descriptor read_end(ends[0]);
    input.number = ends[1];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, read_end.number, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, messages.number, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions, file.descriptor(), kFilmDescriptor);
    const auto lock = holdSignals();
    const int error =
        spawnProgram(programFile("ffmpeg"), ffmpegArguments(format, width, height, rate), actions, 0, child);
    posix_spawn_file_actions_destroy(&actions);
    if (error == 0) return void(killing.emplace([pid = child] { kill(pid, SIGKILL); }));
    child = -1;
    throw MachineError(fmt::format("{}: can't start ffmpeg: {}", path, std::strerror(error)));
  }

  /// Waits for ffmpeg's end. Returns its status as waitpid tells it.
  int await() {
    input.close();
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    killing.reset();
    child = -1;
    return status;
  }

  /// The first line that ffmpeg said.
  std::string firstMessage() const {
    std::array<char, 1000> text{};
    const ssize_t size = pread(messages.number, text.data(), text.size(), 0);
    std::istringstream lines(std::string(text.data(), std::size_t(std::max<ssize_t>(size, 0))));
    std::string line;
    std::getline(lines, line);
    return line;
  }

  void finish() {
    const int status = await();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    const std::string message = firstMessage();
    throw MachineError(fmt::format(
        "{}: ffmpeg {} {}{}{}", path, WIFEXITED(status) ? "failed with status" : "was ended by signal",
        WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status), message.empty() ? "" : ": ", message));
  }

  void send(const std::byte* bytes, std::size_t count) {
    while (count > 0) {
      const ssize_t sent = ::send(input.number, bytes, count, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) {
        const std::string reason = systemReason();
        finish();  // says why, as a rule
        throw MachineError(fmt::format("{}: ffmpeg ended early: {}", path, reason));
      }
      bytes += sent;
      count -= std::size_t(sent);
    }
  }

  struct Frame : RowFile {
    explicit Frame(State& of_film) : film(of_film) {}
    void write(const void* values, int rows) override {
      film.send(static_cast<const std::byte*>(values), film.row_bytes * std::size_t(rows));
    }
    void close() override {}
    State& film;
  };
};

bool isFilm(const std::string& path, const std::string& format) { return findFormat(path, format); }

void checkFilm(const std::string& path, const std::string& format) {
  if (!findFormat(path, format))
    throw InputError(fmt::format("{}: expected a film, .mp4, .webm or .webp", path));
  if (leadsToStream(path))
    throw InputError(fmt::format("{}: a film can't be written to a stream, expected a file", path));
  checkPlace(path);
  if (programFile("ffmpeg").empty())
    throw MachineError(
        fmt::format("{}: films are encoded by the program ffmpeg, which isn't here; install ffmpeg, or make "
                    "pictures, as -o frame.####.png",
                    path));
}

Film::Film(const std::string& path, const std::string& format, int width, int height,
           double frames_per_second) {
  checkFilm(path, format);
  const FilmFormat& how = *findFormat(path, format);
  if (how.is_even && (width % 2 == 1 || height % 2 == 1))
    throw InputError(fmt::format(
        "{}: {} x {} pixels, expected even numbers of them for .{} (see settings.size, or take .webm)", path,
        width, height, how.extension));
  state_ = std::make_unique<State>(path, how, width, height, frames_per_second);
}

Film::~Film() = default;

std::unique_ptr<RowFile> Film::addFrame() { return std::make_unique<State::Frame>(*state_); }

void Film::close() {
  state_->finish();
  struct stat status {};
  if (fstat(state_->file.descriptor(), &status) != 0 || status.st_size == 0)
    throw MachineError(state_->path + ": ffmpeg ended early, and wrote nothing");
  state_->file.putInPlace();
}

}  // namespace luciole
