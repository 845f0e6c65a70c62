#include "reference/mpi_team.h"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <exception>
#include <string>
#include <utility>

#include "base/error.h"
#include "reference/reference_key.h"

namespace lumi {
namespace {

/// What the lead tells another process: an order, and its samples or the length of the key that follows.
using Words = std::array<uint64_t, 3>;

constexpr int kOrders = 1, kBlocks = 2;
constexpr size_t kMostBytes = size_t(1) << 30;  ///< MPI counts in int

void sendBytes(const void* data, size_t bytes, int to, int tag) {
    const char* next = static_cast<const char*>(data);
    for (size_t count; bytes > 0; next += count, bytes -= count) {
        count = std::min(bytes, kMostBytes);
        MPI_Send(next, static_cast<int>(count), MPI_BYTE, to, tag, MPI_COMM_WORLD);
    }
}

void receiveBytes(void* data, size_t bytes, int from, int tag) {
    char* next = static_cast<char*>(data);
    for (size_t count; bytes > 0; next += count, bytes -= count) {
        count = std::min(bytes, kMostBytes);
        MPI_Recv(next, static_cast<int>(count), MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
}

void sendBlock(bool whole, const SampleBlock& block) {
    const uint64_t good = whole ? 1 : 0;
    sendBytes(&good, sizeof(good), 0, kBlocks);
    if (!whole) return;
    sendBytes(block.sum.data(), block.sum.bytes(), 0, kBlocks);
    sendBytes(block.left.data(), block.left.bytes(), 0, kBlocks);
    sendBytes(block.scatter.data(), block.scatter.bytes(), 0, kBlocks);
}

bool receiveBlock(SampleRange range, Extent2 extent, int from, SampleBlock& block) {
    uint64_t good = 0;
    receiveBytes(&good, sizeof(good), from, kBlocks);
    if (good == 0) return false;
    block = SampleBlock::shaped(range, extent);
    receiveBytes(block.sum.data(), block.sum.bytes(), from, kBlocks);
    receiveBytes(block.left.data(), block.left.bytes(), from, kBlocks);
    receiveBytes(block.scatter.data(), block.scatter.bytes(), from, kBlocks);
    return true;
}

}  // namespace

MpiTeam::MpiTeam(int* argc, char*** argv) {
    int provided = 0;
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

MpiTeam::~MpiTeam() { MPI_Finalize(); }

void MpiTeam::send(Order order, SampleRange range, int to) {
    const Words message{static_cast<uint64_t>(order), range.begin, range.end};
    sendBytes(message.data(), sizeof(message), to, kOrders);
}

void MpiTeam::abort(int exitCode) {
    MPI_Abort(MPI_COMM_WORLD, exitCode);
    std::terminate();
}

bool MpiTeam::trace(BlockTracer& own, std::span<const SampleRange> ranges, const std::function<void(SampleBlock)>& take,
                    std::stop_token stop) {
    const int others = static_cast<int>(ranges.size()) - 1;
    for (int rank = 1; rank < size_ && !keySent_; ++rank) {
        const std::string key = referenceKeyText(own.spec());
        send(Order::Key, {0, key.size()}, rank);
        sendBytes(key.data(), key.size(), rank, kOrders);
    }
    keySent_ = true;
    for (int rank = 1; rank <= others; ++rank) send(Order::Trace, ranges[static_cast<size_t>(rank)], rank);

    SampleBlock block;
    bool whole = false;
    std::exception_ptr failure;
    try {
        whole = own.traceBlock(ranges[0], block, stop);
    } catch (...) {
        failure = std::current_exception();  // what the others send has to be received all the same
    }
    if (whole) take(std::move(block));
    for (int rank = 1; rank <= others; ++rank) {
        const SampleRange range = ranges[static_cast<size_t>(rank)];
        whole = receiveBlock(range, own.spec().camera.extent, rank, block) && whole;
        if (whole) take(std::move(block));
    }
    if (failure) std::rethrow_exception(failure);
    return whole;
}

bool MpiTeam::serve(BlockTracer& own, std::stop_token stop) {
    for (;;) {
        Words message{};
        receiveBytes(message.data(), sizeof(message), 0, kOrders);
        switch (static_cast<Order>(message[0])) {
            case Order::NextImage: return true;
            case Order::End: return false;
            case Order::Key: {
                std::string key(message[2], '\0');
                receiveBytes(key.data(), key.size(), 0, kOrders);
                const std::string ownKey = referenceKeyText(own.spec());
                if (key != ownKey)
                    throw Error(ErrorKind::BadInput,
                                {"process " + std::to_string(rank_) + " would make another image", "",
                                 "the same scene, program and --isa everywhere", keyDifference(key, ownKey)});
                break;
            }
            case Order::Trace: {
                SampleBlock block;
                const bool whole = own.traceBlock({message[1], message[2]}, block, stop);
                sendBlock(whole, block);
                break;
            }
        }
    }
}

void MpiTeam::release(Order order) {
    for (int rank = 1; rank < size_; ++rank) send(order, {}, rank);
    keySent_ = false;
}

void MpiTeam::nextImage() { release(Order::NextImage); }
void MpiTeam::end() { release(Order::End); }

}  // namespace lumi
