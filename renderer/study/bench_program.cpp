#include "study/bench_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"

extern char** environ;

namespace lumi {
namespace fs = std::filesystem;

std::string outputOf(const std::vector<std::string>& command) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {};
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const bool started = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::string text;
    char buffer[4096];
    for (ssize_t count; started && (count = read(ends[0], buffer, sizeof(buffer))) > 0;)
        text.append(buffer, static_cast<size_t>(count));
    close(ends[0]);
    int status = 0;
    if (!started || waitpid(child, &status, 0) != child || status != 0) return {};
    return text;
}

ScratchFolder::ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "lumiscope-bench-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw Error(ErrorKind::Resources, {"no folder for temporary files can be made", name, "", ""});
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

uint64_t peakOfRender(const std::string& program, const fs::path& scene, Extent2 extent) {
    const ScratchFolder folder;
    const std::string output = outputOf({program, "render", scene.string(), "--module", "none", "--size",
                                         fmt::format("{}x{}", extent.width, extent.height), "--quiet", "--json",
                                         "--out", (folder.path() / "frame.exr").string()});
    const nlohmann::json result = nlohmann::json::parse(output, nullptr, false);
    return result.is_object() ? result.value("peak_memory_bytes", uint64_t(0)) : 0;
}

}  // namespace lumi
