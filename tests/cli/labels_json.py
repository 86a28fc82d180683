"""Every JSON that the command writes about 50 nasty labels and names of files is read back by Python's own parser.

usage: labels_json.py COMMAND
"""
import json
import os
import subprocess
import sys
import tempfile

LABELS = [
    '"', '\\', '\\"', '"}', '"]}', '",', '{"a":1}', '[1]', 'null', 'true', '1e999', 'NaN', '-0', '',
    '\\u0000', '\\n', '\\ud800', '\\x41', "'", "''", '/', '\\/', '//x', '/* x */', '#', '<!--<script>', '</script>',
    '&quot;', '%s%n%d', '%', '$(id)', '`id`', '${x}', ' ', ' lead', 'trail ', '\t', 'line\nbreak', '\r\n', '\b\f',
    '\x01', '\x1b[2J\x1b]0;x\x07', '\x1f', '\x7f', '\x80\x9b', '\u2028\u2029', '\u202eabc', '\ufeffbom', '\ufffd', '\U0001f480',
    '\xfc\xdf', 'e\u0301', '__proto__', '=1+1', '..', 'x' * 300,
]
LABELS = [label for label in LABELS if label]  # an empty one is no label
NAMES = [label for label in LABELS if '/' not in label and len(label) < 200 and label not in ('..',) and not label.startswith(('-', '='))]


def scene(labels):
    samples = [{'Label': label, 'Sphere': [6, 12.0, 'mm'], 'Material': ['mu', 0.2],
                'Transform': [['Translation', 5.0 * (k % 10) - 25, 0.0, 5.0 * (k // 10) - 15, 'mm']]}
               for k, label in enumerate(labels)]
    return {'Source': {'Position': [0, -400, 0, 'mm'], 'Shape': 'ParallelBeam',
                       'Beam': [{'Energy': 60, 'Unit': 'keV', 'PhotonCount': 1000}]},
            'Detector': {'Position': [0, 100, 0, 'mm'], 'UpVector': [0, 0, -1], 'NumberOfPixels': [33, 25],
                         'Spacing': [4, 4, 'mm']},
            'Scan': {'NumberOfProjections': 2, 'FinalAngle': 360}, 'Samples': samples}


def strings(value):
    """All strings in a JSON value, keys included."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, list):
        for one in value:
            yield from strings(one)
    elif isinstance(value, dict):
        for key, one in value.items():
            yield key
            yield from strings(one)


def refuse(constant):
    raise ValueError(constant + ' is no JSON')


def once(pairs):
    keys = [key for key, _ in pairs]
    assert len(keys) == len(set(keys)), 'a key stands twice: %r' % keys
    return dict(pairs)


def parse(text):
    return json.loads(text, parse_constant=refuse, object_pairs_hook=once)


def commands_nothing(words, text):
    """A text for a terminal holds no control characters, which would command it."""
    controls = [c for c in text if (ord(c) < 32 and c != '\n') or 127 <= ord(c) < 160]
    assert not controls, (words, text)


class Command:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def start(self, words, status):
        done = subprocess.run([self.path, *words], cwd=self.folder, capture_output=True, stdin=subprocess.DEVNULL)
        assert done.returncode == status, (words, done.returncode, done.stderr)
        commands_nothing(words, done.stderr.decode('utf-8'))
        return done.stdout.decode('utf-8')

    def run(self, *words, status=0):
        """Output of the command with --json, parsed."""
        return parse(self.start([*words, '--json'], status))

    def table(self, *words):
        """Output of the command for people."""
        commands_nothing(words, self.start(words, 0))


def write(folder, name, value):
    with open(os.path.join(folder, name), 'w', encoding='utf-8') as file:
        json.dump(value, file)


def main():
    assert len(LABELS) >= 50
    with tempfile.TemporaryDirectory() as folder:
        command = Command(sys.argv[1], folder)
        write(folder, 's.json', scene(LABELS))
        view = command.run('view', 's.json', '-o', 'v.png')
        assert [part['label'] for part in view['parts']] == LABELS
        command.table('view', 's.json', '-o', 'v.png')
        command.run('plan', 's.json')
        command.table('plan', 's.json')
        command.table('plan', 's.json', '--verbose')
        command.run('image', 's.json', '-o', 'i.png')
        command.run('scan', 's.json', '-o', 's.mha')
        command.run('cost', 's.json', '--quick', '--within', '1')
        for k, label in enumerate(LABELS):
            if k % 5 == 0:  # a few at a time: a scene of fifty takes a second to open
                write(folder, 'some.json', scene(LABELS[k:k + 5]))
            if not label.startswith('-'):
                command.run('lbuffer', 'some.json', '--part', label, '-o', 'l.png')
            if k % 5 == 0:
                if not label.startswith('-'):
                    command.run('lbuffer', 's.json', '--part', label, '-o', 'l.png')
                error = command.run('lbuffer', 's.json', '--part', 'no ' + label, '-o', 'l.png', status=3)['error']
                assert set(error) == {'status', 'message', 'where'}, error
        for k, name in enumerate(NAMES):
            write(folder, name + '.json', scene([name]))
            assert name + '.png' in command.run('image', name + '.json', '-o', name + '.png')['files']
            with open(os.path.join(folder, name + '.obj'), 'w', encoding='utf-8') as file:
                file.write('v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n')
            assert name + '.obj' in strings(command.run('mesh', name + '.obj'))
            if k % 6 == 0:
                assert name + '.mha' in strings(command.run('scan', name + '.json', '-o', name + '.mha'))
                command.run('distance', name + '.obj', name + '.obj')
                command.table('mesh', name + '.obj')
        print('%d labels, %d names' % (len(LABELS), len(NAMES)))


main()
