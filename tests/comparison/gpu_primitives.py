# SPDX-License-Identifier: Apache-2.0
"""What the parts of one SAC+DrQ update cost on a GPU, each part alone, inside a CUDA graph.

usage: python tests/comparison/gpu_primitives.py [--batches 128,256,512] [--json FILE]

Each row is one call of cuDNN, cuBLAS or a small kernel, recorded N times in one graph. The time is
the graph's time over N: what the call adds to a recorded update. Inputs are random. Needs PyTorch
with CUDA and Triton; nothing of Shoal.
"""
import argparse, json, statistics, sys
import torch, torch.nn.functional as F

parser = argparse.ArgumentParser()
parser.add_argument('--batches', default='128,256,512')
parser.add_argument('--json')
args = parser.parse_args()
torch.backends.cudnn.benchmark = True
torch.backends.cuda.matmul.allow_tf32 = True
device = 'cuda'
rows = []


def microseconds(call, repeats=20, tries=7):
    """Median over tries of the time one call adds to a graph of `repeats` calls."""
    stream = torch.cuda.Stream()
    stream.wait_stream(torch.cuda.current_stream())
    with torch.cuda.stream(stream):
        for _ in range(3):
            call()
    torch.cuda.current_stream().wait_stream(stream)
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph):
        for _ in range(repeats):
            call()
    for _ in range(3):
        graph.replay()
    times = []
    for _ in range(tries):
        begin, end = torch.cuda.Event(enable_timing=True), torch.cuda.Event(enable_timing=True)
        begin.record()
        for _ in range(10):
            graph.replay()
        end.record()
        end.synchronize()
        times.append(begin.elapsed_time(end) * 1000 / (10 * repeats))
    return statistics.median(times)


def row(name, call, gflop=0.0, megabytes=0.0):
    try:
        us = microseconds(call)
    except Exception as error:  # a row that cannot run is named, the others go on
        print(f'{name}: {type(error).__name__}: {str(error)[:120]}', flush=True)
        return
    rows.append({'name': name, 'us': round(us, 3), 'tflops': round(gflop / us * 1e3, 1),
                 'gb_per_s': round(megabytes / us * 1e3, 1)})
    print(f'{us:9.2f} us  {gflop / us * 1e3:8.1f} TFLOP/s {megabytes / us * 1e3:8.0f} GB/s  {name}', flush=True)


one = torch.zeros(1, device=device)
row('kernel of one element (floor of a node)', lambda: one.add_(1))

LAYERS = {  # channels in, size in, channels out, kernel, stride
    'compact': [(6, 42, 32, 3, 2), (32, 20, 32, 3, 1), (32, 18, 32, 3, 2)],
    'drq': [(9, 84, 32, 3, 2), (32, 41, 32, 3, 1), (32, 39, 32, 3, 1), (32, 37, 32, 3, 1)],
    'nature': [(6, 84, 32, 8, 4), (32, 20, 64, 4, 2), (64, 9, 64, 3, 1)],
}
BF = torch.bfloat16


def images(*shape):
    return torch.randn(*shape, device=device, dtype=BF).contiguous(memory_format=torch.channels_last)


for batch in map(int, args.batches.split(',')):
    for net, layers in LAYERS.items():
        for index, (cin, size, cout, k, s) in enumerate(layers):
            for padded in ([cin] if cin % 8 == 0 else [cin, 8 * ((cin + 7) // 8)]):
                x, w = images(batch, padded, size, size), images(cout, padded, k, k)
                y = F.conv2d(x, w, stride=s)
                g = torch.randn_like(y)
                out = y.shape[2]
                gflop = 2e-9 * batch * out * out * cout * padded * k * k
                mega = 2e-6 * (x.numel() + y.numel())
                label = f'{net} conv{index} {padded}x{size}x{size} -> {cout}x{out}x{out}, batch {batch}'
                row('forward  ' + label, lambda: F.conv2d(x, w, stride=s), gflop, mega)
                back = lambda mask: torch.ops.aten.convolution_backward(
                    g, x, w, None, [s, s], [0, 0], [1, 1], False, [0, 0], 1, mask)
                if index:
                    row('by input ' + label, lambda: back([True, False, False]), gflop, mega)
                row('by weight ' + label, lambda: back([False, True, False]), gflop, mega)
    for n, m in [(2048, 50), (256, 256), (54, 256), (1024, 1024), (39200, 50), (3136, 512)]:
        x = torch.randn(batch, n, device=device, dtype=BF)
        w = torch.randn(m, n, device=device, dtype=BF)
        b = torch.randn(m, device=device, dtype=BF)
        g = torch.randn(batch, m, device=device, dtype=BF)
        gflop = 2e-9 * batch * n * m
        row(f'linear {n} -> {m} forward with bias, batch {batch}', lambda: F.linear(x, w, b), gflop)
        row(f'linear {n} -> {m} by input, batch {batch}', lambda: g @ w, gflop)
        row(f'linear {n} -> {m} by weight, batch {batch}', lambda: g.t() @ x, gflop)

# Frames: copies from pinned memory against a gather on the card.
import triton
import triton.language as tl


@triton.jit
def gather(frames, index, shift, out, H: tl.constexpr, W: tl.constexpr, PAD: tl.constexpr, C: tl.constexpr, BLOCK: tl.constexpr):
    """out[b, y, x, c] (NHWC, bf16, pooled 2x2) of frames[index[b]] (C, H, W) uint8 shifted by shift[b]."""
    b = tl.program_id(0)
    offset = tl.program_id(1) * BLOCK + tl.arange(0, BLOCK)
    c = offset % 8
    x = offset // 8 % (W // 2)
    y = offset // 8 // (W // 2)
    inside = (y < H // 2) & (c < C)
    record = tl.load(index + b).to(tl.int64)
    dy, dx = tl.load(shift + 2 * b), tl.load(shift + 2 * b + 1)
    total = tl.zeros([BLOCK], tl.float32)
    for i in tl.static_range(2):
        for j in tl.static_range(2):
            yy = tl.minimum(tl.maximum(2 * y + i + dy - PAD, 0), H - 1)
            xx = tl.minimum(tl.maximum(2 * x + j + dx - PAD, 0), W - 1)
            total += tl.load(frames + record * C * H * W + c * H * W + yy * W + xx, mask=inside, other=0).to(tl.float32)
    tl.store(out + b * (H // 2) * (W // 2) * 8 + offset, (total / 1020 - 0.5).to(tl.bfloat16), mask=y < H // 2)


stored = torch.randint(0, 255, (50000, 6, 84, 84), device=device, dtype=torch.uint8)
for batch in map(int, args.batches.split(',')):
    index = torch.randint(0, 50000, (batch,), device=device)
    shift = torch.randint(0, 9, (batch, 2), device=device, dtype=torch.int32)
    out = torch.empty(batch, 42, 42, 8, device=device, dtype=BF)
    blocks = (42 * 42 * 8 + 1023) // 1024
    row(f'gather, shift, pool, scale of {batch} records on the card',
        lambda: gather[(batch, blocks)](stored, index, shift, out, 84, 84, 4, 6, 1024), 0, batch * 6 * 84 * 84 / 1e6)
    host = torch.randint(0, 255, (batch, 6, 84, 84), dtype=torch.uint8).pin_memory()
    card = torch.empty_like(host, device=device)
    row(f'copy of {batch} stacks from pinned memory', lambda: card.copy_(host, non_blocking=True), 0, host.numel() / 1e6)
del stored



# The same convolutions by kernels of our own, to see what cuDNN leaves: implicit products, NHWC,
# bias and ReLU in the same kernel; gradients by weight in two steps, which sum in a fixed order.
@triton.jit
def conv_forward(x, w, bias, y, total, S: tl.constexpr, O: tl.constexpr, CIN: tl.constexpr, COUT: tl.constexpr,
                 K: tl.constexpr, STRIDE: tl.constexpr, M: tl.constexpr):
    row = tl.program_id(0) * M + tl.arange(0, M)  # output pixels, (b, y, x) in one number
    b, oy, ox = row // (O * O), row // O % O, row % O
    c, o = tl.arange(0, CIN), tl.arange(0, COUT)
    acc = tl.zeros([M, COUT], tl.float32)
    for tap in tl.static_range(K * K):
        at = ((b * S + oy * STRIDE + tap // K) * S + ox * STRIDE + tap % K) * CIN
        a = tl.load(x + at[:, None] + c[None, :], mask=(row < total)[:, None], other=0)
        f = tl.load(w + (tap * CIN + c)[:, None] * COUT + o[None, :])
        acc += tl.dot(a, f)
    acc = tl.maximum(acc + tl.load(bias + o)[None, :], 0)
    tl.store(y + row[:, None] * COUT + o[None, :], acc.to(tl.bfloat16), mask=(row < total)[:, None])


@triton.jit
def conv_by_weight(x, g, part, total, per, S: tl.constexpr, O: tl.constexpr, CIN: tl.constexpr, COUT: tl.constexpr,
                   K: tl.constexpr, STRIDE: tl.constexpr, M: tl.constexpr):
    share, tap = tl.program_id(0), tl.program_id(1)
    c, o = tl.arange(0, CIN), tl.arange(0, COUT)
    acc = tl.zeros([CIN, COUT], tl.float32)
    for start in range(share * per, share * per + per, M):
        row = start + tl.arange(0, M)
        ok = row < total
        b, oy, ox = row // (O * O), row // O % O, row % O
        at = ((b * S + oy * STRIDE + tap // K) * S + ox * STRIDE + tap % K) * CIN
        a = tl.load(x + at[None, :] + c[:, None], mask=ok[None, :], other=0)
        d = tl.load(g + row[:, None] * COUT + o[None, :], mask=ok[:, None], other=0)
        acc += tl.dot(a, d)
    tl.store(part + ((share * K * K + tap) * CIN + c)[:, None] * COUT + o[None, :], acc)


@triton.jit
def sum_parts(part, out, n, parts, BLOCK: tl.constexpr):
    i = tl.program_id(0) * BLOCK + tl.arange(0, BLOCK)
    acc = tl.zeros([BLOCK], tl.float32)
    for p in range(parts):
        acc += tl.load(part + p * n + i, mask=i < n, other=0)
    tl.store(out + i, acc, mask=i < n)


def own_convolutions(batch, cin, size, cout, k, s):
    x = torch.randn(batch, size, size, cin, device=device, dtype=BF)
    w = torch.randn(k * k * cin, cout, device=device, dtype=BF) * 0.05
    bias = torch.randn(cout, device=device)
    out = (size - k) // s + 1
    total = batch * out * out
    y = torch.full((batch, out, out, cout), float('nan'), device=device, dtype=BF)
    want = F.relu(F.conv2d(x.float().permute(0, 3, 1, 2), w.float().reshape(k, k, cin, cout).permute(3, 2, 0, 1), bias, stride=s)).permute(0, 2, 3, 1)
    label = f'{cin}x{size}x{size} -> {cout}x{out}x{out}, batch {batch}'
    gflop = 2e-9 * total * cout * cin * k * k
    for m in (64, 128):
        call = lambda: conv_forward[((total + m - 1) // m,)](x, w, bias, y, total, size, out, cin, cout, k, s, m)
        call()
        error = ((y.float() - want).norm() / want.norm()).item()
        row(f'own forward with bias and ReLU, {m} pixels a block, error {error:.1e}: {label}', call, gflop)
    g = torch.randn(batch, out, out, cout, device=device, dtype=BF)
    for parts in (15, 30, 60):
        per = ((total + parts - 1) // parts + 127) // 128 * 128
        part = torch.empty(parts, k * k * cin, cout, device=device)
        dw = torch.empty(k * k * cin, cout, device=device)
        n = dw.numel()

        def call():
            conv_by_weight[(parts, k * k)](x, g, part, total, per, size, out, cin, cout, k, s, 128)
            sum_parts[((n + 255) // 256,)](part, dw, n, parts, 256)
        call()
        want_dw = torch.nn.grad.conv2d_weight(x.float().permute(0, 3, 1, 2), (cout, cin, k, k), g.float().permute(0, 3, 1, 2), stride=s)
        want_dw = want_dw.permute(2, 3, 1, 0).reshape(k * k * cin, cout)
        error = ((dw - want_dw).norm() / want_dw.norm()).item()
        row(f'own by weight in {parts} shares and their sum, error {error:.1e}: {label}', call, gflop)


torch.backends.cudnn.allow_tf32 = False
for batch in (128, 256):
    own_convolutions(batch, 32, 20, 32, 3, 1)
    own_convolutions(batch, 32, 18, 32, 3, 2)
    own_convolutions(batch, 16, 42, 32, 3, 2)
    own_convolutions(batch, 32, 39, 32, 3, 1)


# Both heads of a critic, forward, as one kernel: three products, two LayerNorms with ReLU between.
@triton.jit
def norm_relu(h, N: tl.constexpr):
    mean = tl.sum(h, 1) / N
    d = h - mean[:, None]
    return tl.maximum(d * tl.rsqrt(tl.sum(d * d, 1) / N + 1e-5)[:, None], 0).to(tl.bfloat16)


@triton.jit
def heads_forward(x, w0, w1, w2, q, B, IN: tl.constexpr, H: tl.constexpr, M: tl.constexpr):
    head = tl.program_id(1)
    r, i, h = tl.program_id(0) * M + tl.arange(0, M), tl.arange(0, IN), tl.arange(0, H)
    a = tl.load(x + r[:, None] * IN + i[None, :])
    a = norm_relu(tl.dot(a, tl.load(w0 + head * IN * H + i[:, None] * H + h[None, :])), H)
    acc = tl.dot(a, tl.load(w1 + head * H * H + h[:, None] * H + h[None, :]))
    a = norm_relu(acc, H)
    last = tl.load(w2 + head * H + h)
    tl.store(q + head * B + r, tl.sum(a.to(tl.float32) * last[None, :], 1))


for batch in (128, 256):
    x = torch.randn(batch, 64, device=device, dtype=BF)
    w0, w1 = torch.randn(2, 64, 256, device=device, dtype=BF), torch.randn(2, 256, 256, device=device, dtype=BF)
    w2, q = torch.randn(2, 256, device=device), torch.full((2, batch), float('nan'), device=device)
    gflop = 2e-9 * 2 * batch * (64 * 256 + 256 * 256 + 256)
    for m in (16, 32):
        call = lambda: heads_forward[(batch // m, 2)](x, w0, w1, w2, q, batch, 64, 256, m, num_warps=8)
        try:
            call()
        except Exception as error:
            print(f'heads {m}: {str(error)[:150]}')
            continue
        row(f'own forward of two heads 64 -> 256 -> 256 -> 1 with LayerNorm and ReLU, {m} rows a block, batch {batch}', call, gflop)

# One optimiser step over all parameters of the flagship's size (0.5 million), fused.
for count in (500_000, 4_000_000):
    p, g, m, v = (torch.randn(count, device=device) for _ in range(4))
    v.abs_()
    step = torch.ones(1, device=device)
    row(f'fused Adam over {count} parameters',
        lambda: torch._fused_adam_([p], [g], [m], [v], [], [step], lr=1e-4, beta1=0.9, beta2=0.999, weight_decay=0.0, eps=1e-8, amsgrad=False, maximize=False),
        0, count * 28 / 1e6)
if args.json:
    json.dump({'schema': 'shoal-gpu-primitives-1', 'card': torch.cuda.get_device_name(), 'torch': torch.__version__,
               'cudnn': torch.backends.cudnn.version(), 'rows': rows}, open(args.json, 'w'), indent=1)
