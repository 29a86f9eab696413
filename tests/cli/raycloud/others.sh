# A program rayNAME anywhere in PATH is a command too; its words arrive as they were typed.
mkdir -p elsewhere
cat >elsewhere/raymine <<'PROGRAM'
#!/bin/sh
for word; do echo "<$word>"; done
exit 7
PROGRAM
chmod +x elsewhere/raymine
PATH=$PATH:$PWD/elsewhere
expect 7 raycloud mine 'two words' '' -h --threads '*'
