// SPDX-License-Identifier: Apache-2.0
// The remote side in tests of the link: executes text commands on a hub. dds_peer executes the
// commands in a separate process. Tests of the link in memory execute the commands on a thread
// (contract_network.h).
//
// T is the name of a message type. Each command has one answer line:
//
//   subscribe T                makes the reader and counts messages; "ok"
//   show T                     like subscribe, and prints "got T DESCRIPTION" for each message
//   unsubscribe T              starts a thread that destroys the reader; "ok"
//   unsubscribed T MS          waits for the end of that thread; "yes" or "no"
//   publish T                  makes the writer; "ok"
//   unpublish T                destroys the writer; "ok"
//   match T N MS               waits until reader and writer of T together have N peers;
//                              "matched N"
//   write T FIRST COUNT BYTES [KEY]
//                              writes numbered messages and repeats refused writes;
//                              "wrote COUNT refused N seconds S"
//   scribble T FIRST COUNT BYTES
//                              like write, each on a new thread with the payload of its number,
//                              from one buffer that is overwritten after each write
//   try T N BYTES              one write; "sent MS" or "refused MS"
//   announce T N BYTES         like try; prints "got trying T" directly before the write
//   received T COUNT MS        waits for COUNT messages; "received N gaps N bytes N malformed N"
//   seen T                     "seen KEY:NUMBER ...", every message in the order of the callbacks
//   hold T                     callbacks of T wait from now on; "ok"
//   release T                  callbacks do not wait any more; "ok"
//   waiting T MS               waits until a callback waits; "yes" or "no"
//   overlaps T                 number of callbacks that began during another; "overlaps N"
//   acknowledged T MS          waits until all writes of T are acknowledged; "yes" or "no"
//   malformed                  the hub's counts of malformed messages; "malformed TOPIC:N ..."
//   answer                     stores nothing, but answers every chunk with a credit; "ok"
//   roundtrip COUNT BYTES      chunk out, credit back, COUNT > 1 times; "microseconds MEDIAN MAX,
//                              first FIRST": the first trip also waits until the reader has matched
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/link/hub.h"

namespace shoal::link {

class PeerCommands {
 public:
  // Borrows the hub. `say` gets the "got" lines and may be called on any thread.
  PeerCommands(Hub& hub, std::function<void(const std::string&)> say);
  // Releases held callbacks.
  ~PeerCommands();
  PeerCommands(const PeerCommands&) = delete;
  PeerCommands& operator=(const PeerCommands&) = delete;

  // Executes one command and returns its answer. One call at a time.
  std::string Run(const std::string& line);

  class Endpoint;
  class Answerer;

 private:
  Hub& hub_;
  std::map<std::string, std::unique_ptr<Endpoint>> endpoints_;  // by message type
  std::unique_ptr<Answerer> answerer_;
};

}  // namespace shoal::link
