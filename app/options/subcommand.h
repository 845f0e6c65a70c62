#pragma once
#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli.h"

namespace lumi {

/// One command's options: declared to CLI11 when it is made, checked and completed by finish() if the command is used.
/// Values go straight into the command line that it was made with.
class Subcommand {
public:
    virtual ~Subcommand() = default;
    bool used() const { return app_->parsed(); }
    /// Throws Error(Usage).
    virtual void finish() = 0;

protected:
    Subcommand(CLI::App& parent, CommandLine& line, const char* name, const char* help)
        : app_(parent.add_subcommand(name, help)), line_(line) {}

    CLI::App* app_;
    CommandLine& line_;
};

std::unique_ptr<Subcommand> makeRenderOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeReferenceOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeMergeOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeCompareOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeStudyOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeBenchOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeInfoOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeListOptions(CLI::App& parent, CommandLine& line);
std::unique_ptr<Subcommand> makeViewOptions(CLI::App& parent, CommandLine& line);

}  // namespace lumi
