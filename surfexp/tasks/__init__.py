"""What a person does with a surface, one task a module; `import surfexp` offers them all."""

from surfexp.first_call import announce_compilation

announce_compilation()
