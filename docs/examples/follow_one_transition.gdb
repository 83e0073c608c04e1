# Stops once at each place that a transition passes, in order (docs/debugger.md):
#   gdb -x docs/examples/follow_one_transition.gdb --args \
#     build/release/bin/shoal train --in-process --preset fetch-reach-state
set breakpoint pending on
set print thread-events off
handle SIGHUP SIGTSTP nostop noprint pass

# The actor steps an environment, which writes the record's arrays.
tbreak shoal::worlds::WorldEnvironment::Step
# A chunk of records is full, or has waited long enough: it goes to the link.
tbreak shoal::actor::HubChunkLink::Send
# The replay receives it, on a thread of the link.
tbreak shoal::replay::ServiceInbox::OnChunk
# The replay's own thread stores a record.
tbreak shoal::replay::Ring::Append
# It draws a batch for the learner, with the shifts of its pictures.
tbreak shoal::replay::BatchGather::Gather
# The learner receives the batch's place, on a thread of the link.
tbreak shoal::learner::BatchSource::OnSlot
# It computes one update of the batch.
tbreak shoal::learner::TrainingLoop::Submit
# An actor receives the new weights.
tbreak shoal::actor::WeightsInbox::OnMessage

run
