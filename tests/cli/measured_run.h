// For tests of memory: runs the program and measures its peak.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace limpid {

struct MeasuredRun {
    int code = -1;
    uint64_t peak = 0;   ///< of the resident memory, bytes
    std::string output;  ///< stdout and stderr
};

/// Runs a program with its arguments, without a shell, and writes its output to the file `log`.
inline MeasuredRun runMeasured(std::vector<std::string> words, const std::string& log) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, 1);
        ::dup2(file, 2);
        ::execv(arguments[0], arguments.data());
        ::_exit(127);
    }
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    std::ifstream stream(log);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            static_cast<uint64_t>(usage.ru_maxrss) * 1024,
            {std::istreambuf_iterator<char>(stream), {}}};
}

}  // namespace limpid
