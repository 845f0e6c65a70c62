#pragma once
#include <memory>

#include "reference/block_tracer.h"

namespace lumi {

/// The processes of one MPI program, on one machine or several. The first (lead) makes references as a process alone
/// does, but hands out blocks of samples; the others trace what they are told. Blocks are added up by the lead in the
/// order of their samples, so the number of processes changes no bit. All calls on one thread.
class MpiTeam : public BlockTeam {
public:
    /// Starts MPI; once in a program.
    MpiTeam(int* argc, char*** argv);
    ~MpiTeam() override;
    MpiTeam(const MpiTeam&) = delete;
    MpiTeam& operator=(const MpiTeam&) = delete;

    bool leads() const { return rank_ == 0; }
    int size() const override { return size_; }

    /// The lead's part.
    bool trace(BlockTracer& own, std::span<const SampleRange> ranges, const std::function<void(SampleBlock)>& take,
               std::stop_token stop) override;
    /// The others' part: traces blocks of this tracer's spec until the lead goes on to the next one. False if the lead
    /// has come to an end.
    bool serve(BlockTracer& own, std::stop_token stop);
    /// Lead: the others leave serve() for the next image.
    void nextImage() override;
    /// Lead: the others leave serve(), and there is no next image.
    void end();
    /// Ends all processes at once, where one cannot go on.
    [[noreturn]] void abort(int exitCode);

private:
    enum class Order : uint64_t { Trace, Key, NextImage, End };
    static void send(Order order, SampleRange range, int to);
    void release(Order order);

    bool keySent_ = false;  ///< of the present image
    int rank_ = 0, size_ = 1;
};

}  // namespace lumi
