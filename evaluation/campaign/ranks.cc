// SPDX-License-Identifier: BSD-3-Clause
// Rank 0 sends numbers, the others answer with replies. Both look for messages every few milliseconds and sleep in
// between. MPI's own waiting would keep a processor busy that the flights need. To end, rank 0 sends an invalid number.
// Each rank then drops its work and answers with an empty message, its last. So no message is left unread when MPI is
// shut down.
// MPI's functions are called by the second names that the standard gives them for profilers. The MUMPS that Ipopt links
// has empty functions with some of the first names, and these are found before the real ones.
#include "evaluation/campaign/ranks.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

#include <mpi.h>
#include <poll.h>

namespace touchdown::evaluation {
namespace {

constexpr int kTag = 1;
constexpr int kEndOfWork = -1;
constexpr int kPollMs = 2;

struct Message {
  int from = 0;
  std::string bytes;
};

// The next message that is there, if one is.
bool TakeMessage(Message* message) {
  int there = 0;
  MPI_Status status;
  PMPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return false;
  int size = 0;
  PMPI_Get_count(&status, MPI_BYTE, &size);
  message->from = status.MPI_SOURCE;
  message->bytes.resize(static_cast<std::size_t>(size));
  PMPI_Recv(message->bytes.data(), size, MPI_BYTE, message->from, kTag, MPI_COMM_WORLD,
            MPI_STATUS_IGNORE);
  return true;
}

void Send(int to, const std::string& bytes) {
  PMPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, kTag, MPI_COMM_WORLD);
}

void SendNumber(int to, int number) {
  Send(to, std::string(reinterpret_cast<const char*>(&number), sizeof(number)));
}

int NumberIn(const std::string& bytes) {
  int number = kEndOfWork;
  std::memcpy(&number, bytes.data(), std::min(bytes.size(), sizeof(number)));
  return number;
}

std::string Packed(const WorkerReply& reply) {
  const int head[2] = {reply.item, static_cast<int>(reply.end)};
  return std::string(reinterpret_cast<const char*>(head), sizeof(head)) + reply.text;
}

WorkerReply Unpacked(const std::string& bytes) {
  int head[2];
  std::memcpy(head, bytes.data(), sizeof(head));
  return {head[0], static_cast<WorkerReply::End>(head[1]), bytes.substr(sizeof(head))};
}

// Sleeps a little; whether the worker, if it is busy, has its reply.
bool Nap(const WorkerProcess& worker) {
  pollfd wait{worker.descriptor(), POLLIN, 0};
  return poll(&wait, worker.busy() ? 1 : 0, kPollMs) > 0;
}

// Rank 0's side of the end.
void Dismiss(int size) {
  for (int rank = 1; rank < size; ++rank) SendNumber(rank, kEndOfWork);
  Message message;
  for (int left = size - 1; left > 0;) {
    if (!TakeMessage(&message)) {
      poll(nullptr, 0, kPollMs);
    } else if (message.bytes.empty()) {
      --left;
    }
  }
}

}  // namespace

Ranks::Ranks() {
  PMPI_Init(nullptr, nullptr);
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  PMPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  if (leads()) {
    Dismiss(size_);
  } else if (std::uncaught_exceptions() > 0) {
    PMPI_Abort(MPI_COMM_WORLD, 1);  // rank 0 would wait for its answer
  }
  PMPI_Finalize();
}

bool Ranks::Agree(const std::string& text) const {
  unsigned long long length = text.size();
  PMPI_Bcast(&length, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
  std::string first = text;
  first.resize(length);
  PMPI_Bcast(first.data(), static_cast<int>(length), MPI_BYTE, 0, MPI_COMM_WORLD);
  const int same = first == text ? 1 : 0;
  int all = 0;
  PMPI_Allreduce(&same, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return all == 1;
}

void Ranks::Lead(WorkerProcess& worker, const std::vector<int>& items,
                 const std::function<void(const WorkerReply&)>& take,
                 const std::function<bool()>& stop) {
  std::vector<char> busy(static_cast<std::size_t>(size_), 0);
  std::size_t next = 0, under_way = 0;
  while (!stop()) {
    for (int rank = 1; rank < size_ && next < items.size(); ++rank) {
      if (std::exchange(busy[static_cast<std::size_t>(rank)], 1) != 0) continue;
      SendNumber(rank, items[next++]);
      ++under_way;
    }
    if (!worker.busy() && next < items.size()) {
      worker.Start(items[next++]);
      ++under_way;
    }
    if (under_way == 0) break;
    Message message;
    while (TakeMessage(&message)) {
      busy[static_cast<std::size_t>(message.from)] = 0;
      --under_way;
      take(Unpacked(message.bytes));
    }
    if (Nap(worker)) {
      --under_way;
      take(worker.Receive());
    }
  }
}

void Ranks::Follow(WorkerProcess& worker) {
  Message message;
  for (;;) {
    while (TakeMessage(&message)) {
      const int item = NumberIn(message.bytes);
      if (item == kEndOfWork) return Send(0, "");
      worker.Start(item);
    }
    if (Nap(worker)) Send(0, Packed(worker.Receive()));
  }
}

}  // namespace touchdown::evaluation
