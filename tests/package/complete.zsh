# SPDX-License-Identifier: Apache-2.0
# Types words into an interactive zsh that has ./saccade.zsh, presses TAB, and prints the last word of the line as it is then.
# Usage: zsh -f complete.zsh WORDS
zmodload zsh/zpty
zpty -b shell 'TERM=dumb PS1= zsh -f -i'
zpty -w shell "autoload -Uz compinit; compinit -u -D; source ./saccade.zsh; print rea''dy"
until [[ $seen == *ready* ]]; do zpty -r -t shell part && seen+=$part || sleep 0.05; done
zpty -w -n shell "$*"$'\t'
seen=
until [[ $seen == *"$*"?* ]] || ((++waits > 400)); do zpty -r -t shell part && seen+=$part || sleep 0.05; done
sleep 0.1
while zpty -r -t shell part; do seen+=$part; done
zpty -d shell
words=(${=seen})
print -r -- "$words[-1]"
