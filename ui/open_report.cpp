#include "ui/open_report.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "base/files.h"

namespace lumi {
namespace fs = std::filesystem;

fs::path reportAt(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        const fs::path report = path / "report.html";
        return fs::is_regular_file(report, ignored) ? report : fs::path();
    }
    return lowerExtension(path) == ".html" ? path : fs::path();
}

void openInBrowser(const fs::path& file, MessageLog& log) {
    std::string program = "xdg-open", name = fs::absolute(file).string();
    char* arguments[] = {program.data(), name.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failure = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
        return log.warning(name + ": no browser could be started (xdg-open is not installed); open it by hand");
    std::thread([child] { waitpid(child, nullptr, 0); }).detach();
    log.info("Opening " + name + " in the browser");
}

}  // namespace lumi
