// SPDX-License-Identifier: Apache-2.0
// The far side of tests of the link: carries out text commands on a hub. dds_peer runs them in a
// process of its own, tests of the link within one process on a thread (contract_network.h).
//
// T is the name of a message type. Each command has one answer line:
//
//   subscribe T                makes the reader and counts what arrives; "ok"
//   show T                     the same, and says "got T DESCRIPTION" for each message
//   unsubscribe T              destroys the reader, on a thread of its own; "ok"
//   unsubscribed T MS          waits for the end of that; "yes" or "no"
//   publish T                  makes the writer; "ok"
//   unpublish T                destroys the writer; "ok"
//   match T N MS               waits until reader and writer of T together have N peers;
//                              "matched N"
//   write T FIRST COUNT BYTES [KEY]
//                              writes numbered messages, repeating those that are refused;
//                              "wrote COUNT refused N seconds S"
//   scribble T FIRST COUNT BYTES
//                              the same, each with a payload of its own number, from one buffer
//                              that is overwritten after each write, and on a thread each
//   try T N BYTES              one write; "sent MS" or "refused MS"
//   announce T N BYTES         the same; says "got trying T" right before the write
//   received T COUNT MS        waits for COUNT messages; "received N gaps N bytes N malformed N"
//   seen T                     "seen KEY:NUMBER ...", every message in the order of the callbacks
//   hold T                     callbacks of T wait from now on; "ok"
//   release T                  callbacks do not wait any more; "ok"
//   waiting T MS               waits until a callback waits; "yes" or "no"
//   overlaps T                 callbacks that began before the one before them ended; "overlaps N"
//   acknowledged T MS          "yes" or "no"
//   malformed                  of the hub; "malformed TOPIC:N ..."
//   answer                     stores nothing, but answers every chunk with a credit; "ok"
//   roundtrip COUNT BYTES      chunk out, credit back, COUNT > 1 times; "microseconds MEDIAN MAX,
//                              first FIRST": the first one waits for the reader's side of matching
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
  // Releases what is held.
  ~PeerCommands();
  PeerCommands(const PeerCommands&) = delete;
  PeerCommands& operator=(const PeerCommands&) = delete;

  // The answer. One command at a time.
  std::string Run(const std::string& line);

  class Endpoint;
  class Answerer;

 private:
  Hub& hub_;
  std::map<std::string, std::unique_ptr<Endpoint>> endpoints_;  // by message type
  std::unique_ptr<Answerer> answerer_;
};

}  // namespace shoal::link
