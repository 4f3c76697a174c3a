// For tests of the command line: runs the program in a temporary folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace limpid {

namespace fs = std::filesystem;

struct Result {
    int code = -1;
    std::string output;  ///< stdout and stderr
};

/// `Base`: a fixture that the tests need besides.
template <typename Base>
class ProgramTest : public Base {
  protected:
    void SetUp() override {
        Base::SetUp();
        folder_ = fs::temp_directory_path() / ("limpid_cli_test." + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override {
        fs::remove_all(folder_);
        Base::TearDown();
    }

    static Result run(const std::string& arguments) {
        return runProgram(std::string("'") + LIMPID_PROGRAM + "' " + arguments);
    }
    static Result runProgram(const std::string& command) {
        Result result;
        FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
        std::array<char, 4096> buffer{};
        while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
            result.output.append(buffer.data(), count);
        }
        const int status = ::pclose(pipe);
        result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return result;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
    std::string get(const std::string& name) const {
        std::ifstream stream(folder_ / name);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static void expect(const std::string& arguments, int code, const std::string& part) {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, code) << arguments << "\n" << result.output;
        EXPECT_NE(result.output.find(part), std::string::npos) << arguments << "\n" << result.output;
    }

    fs::path folder_;
};
using CliTest = ProgramTest<testing::Test>;

}  // namespace limpid
