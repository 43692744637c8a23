// Words of the page in English and Brazilian Portuguese. What the program itself says stays in English.

const en = {
  'app.title': 'Faba live lab',
  'tab.bench': 'Bench', 'bench.title': 'Through the camera of a bench', 'bench.help': 'No current flows here: runs on a bench are begun with faba rig run.',
  'bench.scene': 'Scene with a bench', 'bench.open': 'Open the camera', 'bench.close': 'Close the camera', 'bench.picture': 'What the camera sees', 'bench.waiting': 'Waiting for the first picture.',
  'bench.frames': '{n} frames, {dropped} dropped, {corrupt} corrupt', 'bench.grey': 'mean grey {mean}', 'bench.white': '{share} % white', 'bench.camera': 'Camera', 'bench.nothing': 'Nothing can be set at this camera.',
  'bench.exposure': 'Exposure', 'bench.gain': 'Gain', 'bench.white_balance': 'White balance', 'bench.automatic': 'by itself', 'bench.scale': 'Scale',
  'bench.scale.help': 'Put a ruler under the microscope, once for each objective.', 'bench.objective': 'Objective', 'bench.tick': 'Neighbouring marks are apart', 'bench.measure': 'Measure the ruler',
  'bench.interval': '(95 %: {low} to {high})', 'bench.kept': '{n} marks found; kept as {file}.', 'bench.poor': '{n} marks found, too few or too uneven: not kept.', 'bench.marks': 'The marks that were found',
  'tab.lab': 'Lab', 'tab.gallery': 'Gallery', 'tab.runs': 'Runs', 'tab.analyse': 'Analyse',
  'lost': 'The connection is lost; trying again.', 'refused': 'This page has no token any more: open the address that faba lab printed.', 'again': 'Try now',
  'steer.other': 'Another page steers.', 'steer.take': 'Steer from here', 'pages': '{n} pages',
  'hint.1': 'Drag on the picture: the field pulls the swarm along.',
  'hint.2': 'Click to set a goal for the controller; hold Shift and click the points of a route.',
  'hint.3': 'Everything else is in the panel: change it while it runs. Space pauses.',
  'hint.close': 'Understood',
  'run.pause': 'Pause', 'run.go': 'Go on', 'run.step': 'One frame', 'run.restart': 'From the beginning', 'run.speed': 'Speed', 'run.real': 'really {x}×',
  'run.reverse': 'Reverse the field', 'run.save': 'Record', 'run.name': 'Name of the recording', 'run.none': 'Nothing runs yet. Choose a scene.', 'run.stopped': 'The run has ended',
  'steer': 'Steer', 'steer.hand': 'By hand', 'steer.goal': 'To a goal', 'steer.route': 'Along a route', 'steer.strength': 'Strength', 'steer.stop': 'No field',
  'steer.hand.help': 'Drag on the picture, or use the arrow keys or a gamepad.', 'steer.goal.help': 'Click on the picture.',
  'steer.route.help': 'Hold Shift and click the points of the route one after the other, then send it. Drag a point to move it.', 'steer.route.send': 'Go along it', 'steer.route.clear': 'Clear',
  'scenario': 'Scenario', 'scenario.restart': 'Start with these', 'scenario.live': 'Change now', 'scenario.save': 'Save as file', 'scenario.load': 'Load a file', 'scenario.copy': 'Copy command', 'scenario.copied': 'Copied',
  'scenario.undo': 'Undo', 'scenario.advanced': 'All settings', 'seed.new': 'Another seed', 'seed.now': 'seed {n}', 'scenario.anew': 'needs a new beginning', 'scenario.changed_now': 'changed',
  'read.swarm': 'Swarm', 'read.spread': 'spread', 'read.goal': 'to the goal', 'read.responding': 'respond', 'read.currents': 'coils', 'read.coil': 'Coil',
  'run.as_seen': 'as the camera sees it (for analysis)', 'gallery.cancel': 'Cancel', 'scenario.from_first': 'It has these values from the first frame on; a recording has what was done when it was done.', 'scenario.needs_file': 'Save it first, as {file}.', 'form.range': 'from {low} to {high}', 'analyse.current': 'Currents, A',
  'layers': 'Show', 'layer.trails': 'Trails', 'layer.density': 'Density', 'layer.field': 'Field', 'layer.edge': 'Edge', 'layer.swarm': 'Swarm', 'layer.route': 'Goal', 'layer.camera': 'Camera picture', 'view.whole': 'Whole view',
  'plots': 'Plots', 'plot.distance': 'Distance to the goal', 'plot.dispersion': 'Dispersion', 'plot.field': 'Field', 'plot.responding': 'Cells that respond', 'plot.speed': 'Speed of the swarm', 'plot.activity': 'Activity: mean speed of the cells', 'plot.earlier': 'earlier',
  'gallery.title': 'Scenes', 'gallery.start': 'Start', 'gallery.drop': 'Drop a picture or video of a real drop here, or choose one', 'gallery.looking': 'Looking for the edge …', 'gallery.edge': 'The edge of the drop',
  'gallery.edge.help': 'Drag the circle or its rim where it does not fit, then start.', 'gallery.cells': '{n} cells', 'gallery.no_drop': 'The program has no arena with a circular edge.',
  'runs.title': 'Recorded runs', 'runs.none': 'There are none yet: press Record while a swarm swims.', 'runs.report': 'Report', 'runs.replay': 'Replay', 'runs.again': 'Start from it', 'runs.pin': 'Compare', 'runs.broken': 'not complete',
  'jobs': 'Work', 'jobs.none': 'Nothing to do.', 'jobs.cancel': 'Stop', 'job.waiting': 'waits', 'job.running': 'runs', 'job.done': 'done', 'job.failed': 'failed', 'job.cancelled': 'stopped', 'job.left': '{t} left', 'job.open': 'Open', 'job.close': 'Close', 'job.tab': 'In a tab of its own',
  'analyse.title': 'Analyse', 'analyse.activity': 'Activity of a video', 'analyse.compare': 'Compare two videos', 'analyse.identify': 'Identify a model, compare controllers', 'analyse.field': 'Map of a field', 'analyse.start': 'Start', 'analyse.direction': 'Direction of the field, degrees', 'analyse.video': 'Video or run', 'analyse.reference': 'Reference', 'analyse.study': 'Study', 'analyse.rig': 'Rig',
  'form.number': 'must be a number', 'form.unit': 'needs a unit such as {unit}', 'form.whole': 'must be a whole number', 'form.least': 'must be at least {limit}', 'form.most': 'must be at most {limit}', 'form.source': 'from: {source}', 'form.reset': 'Back to the usual value', 'form.add': 'Add', 'form.remove': 'Remove', 'form.none': 'none', 'form.pair': 'needs two numbers, x and y, on each line', 'form.type': 'type', 'form.preset': 'preset', 'form.no_preset': 'own values',
  'view.label': 'The swarm as the microscope sees it',
  'language': 'Language', 'theme': 'Light or dark', 
} as const;

export type Word = keyof typeof en;

const pt: Record<Word, string> = {
  'app.title': 'Faba, laboratório ao vivo',
  'tab.bench': 'Bancada', 'bench.title': 'Pela câmera de uma bancada', 'bench.help': 'Aqui não passa corrente: as corridas na bancada começam com faba rig run.',
  'bench.scene': 'Cena com bancada', 'bench.open': 'Abrir a câmera', 'bench.close': 'Fechar a câmera', 'bench.picture': 'O que a câmera vê', 'bench.waiting': 'Esperando a primeira imagem.',
  'bench.frames': '{n} quadros, {dropped} perdidos, {corrupt} danificados', 'bench.grey': 'cinza médio {mean}', 'bench.white': '{share} % branco', 'bench.camera': 'Câmera', 'bench.nothing': 'Nada se ajusta nesta câmera.',
  'bench.exposure': 'Exposição', 'bench.gain': 'Ganho', 'bench.white_balance': 'Balanço de branco', 'bench.automatic': 'automático', 'bench.scale': 'Escala',
  'bench.scale.help': 'Ponha uma régua sob o microscópio, uma vez para cada objetiva.', 'bench.objective': 'Objetiva', 'bench.tick': 'Distância entre marcas vizinhas', 'bench.measure': 'Medir a régua',
  'bench.interval': '(95 %: {low} a {high})', 'bench.kept': '{n} marcas encontradas; guardado em {file}.', 'bench.poor': '{n} marcas encontradas, poucas ou irregulares: não guardado.', 'bench.marks': 'As marcas encontradas',
  'tab.lab': 'Laboratório', 'tab.gallery': 'Galeria', 'tab.runs': 'Gravações', 'tab.analyse': 'Análise',
  'lost': 'A conexão caiu; tentando de novo.', 'refused': 'Esta página não tem mais a senha: abra o endereço que faba lab mostrou.', 'again': 'Tentar agora',
  'steer.other': 'Outra página está no comando.', 'steer.take': 'Comandar daqui', 'pages': '{n} páginas',
  'hint.1': 'Arraste sobre a imagem: o campo puxa o enxame.',
  'hint.2': 'Clique para dar um alvo ao controlador; com Shift, clique os pontos de uma rota.',
  'hint.3': 'O resto está no painel: mude enquanto roda. A barra de espaço pausa.',
  'hint.close': 'Entendi',
  'run.pause': 'Pausar', 'run.go': 'Continuar', 'run.step': 'Um quadro', 'run.restart': 'Do início', 'run.speed': 'Velocidade', 'run.real': 'de fato {x}×',
  'run.reverse': 'Inverter o campo', 'run.save': 'Gravar', 'run.name': 'Nome da gravação', 'run.none': 'Nada roda ainda. Escolha uma cena.', 'run.stopped': 'A simulação terminou',
  'steer': 'Comando', 'steer.hand': 'À mão', 'steer.goal': 'Até um alvo', 'steer.route': 'Por uma rota', 'steer.strength': 'Intensidade', 'steer.stop': 'Sem campo',
  'steer.hand.help': 'Arraste sobre a imagem, ou use as setas do teclado ou um gamepad.', 'steer.goal.help': 'Clique na imagem.',
  'steer.route.help': 'Com Shift, clique nos pontos da rota, um após o outro, e envie. Arraste um ponto para movê-lo.', 'steer.route.send': 'Seguir a rota', 'steer.route.clear': 'Apagar',
  'scenario': 'Cenário', 'scenario.restart': 'Começar com estes', 'scenario.live': 'Mudar agora', 'scenario.save': 'Salvar em arquivo', 'scenario.load': 'Abrir arquivo', 'scenario.copy': 'Copiar comando', 'scenario.copied': 'Copiado',
  'scenario.undo': 'Desfazer', 'scenario.advanced': 'Todos os ajustes', 'seed.new': 'Outra semente', 'seed.now': 'semente {n}', 'scenario.anew': 'precisa começar de novo', 'scenario.changed_now': 'mudado',
  'read.swarm': 'Enxame', 'read.spread': 'dispersão', 'read.goal': 'até o alvo', 'read.responding': 'respondem', 'read.currents': 'bobinas', 'read.coil': 'Bobina',
  'run.as_seen': 'como a câmera vê (para análise)', 'gallery.cancel': 'Cancelar', 'scenario.from_first': 'Usa estes valores desde o primeiro quadro; uma gravação tem o que foi feito, quando foi feito.', 'scenario.needs_file': 'Salve antes, como {file}.', 'form.range': 'de {low} a {high}', 'analyse.current': 'Correntes, A',
  'layers': 'Mostrar', 'layer.trails': 'Rastros', 'layer.density': 'Densidade', 'layer.field': 'Campo', 'layer.edge': 'Borda', 'layer.swarm': 'Enxame', 'layer.route': 'Alvo', 'layer.camera': 'Imagem da câmera', 'view.whole': 'Ver tudo',
  'plots': 'Gráficos', 'plot.distance': 'Distância ao alvo', 'plot.dispersion': 'Dispersão', 'plot.field': 'Campo', 'plot.responding': 'Células que respondem', 'plot.speed': 'Velocidade do enxame', 'plot.activity': 'Atividade: velocidade média das células', 'plot.earlier': 'anterior',
  'gallery.title': 'Cenas', 'gallery.start': 'Começar', 'gallery.drop': 'Solte aqui uma foto ou um vídeo de uma gota real, ou escolha um arquivo', 'gallery.looking': 'Procurando a borda …', 'gallery.edge': 'A borda da gota',
  'gallery.edge.help': 'Arraste o círculo ou sua borda onde não encaixa, e comece.', 'gallery.cells': '{n} células', 'gallery.no_drop': 'O programa não tem arena com borda circular.',
  'runs.title': 'Gravações', 'runs.none': 'Ainda não há nenhuma: clique em Gravar enquanto um enxame nada.', 'runs.report': 'Relatório', 'runs.replay': 'Rever', 'runs.again': 'Começar daqui', 'runs.pin': 'Comparar', 'runs.broken': 'incompleta',
  'jobs': 'Tarefas', 'jobs.none': 'Nada a fazer.', 'jobs.cancel': 'Parar', 'job.waiting': 'espera', 'job.running': 'roda', 'job.done': 'pronta', 'job.failed': 'falhou', 'job.cancelled': 'parada', 'job.left': 'faltam {t}', 'job.open': 'Abrir', 'job.close': 'Fechar', 'job.tab': 'Em outra aba',
  'analyse.title': 'Análise', 'analyse.activity': 'Atividade de um vídeo', 'analyse.compare': 'Comparar dois vídeos', 'analyse.identify': 'Identificar um modelo, comparar controladores', 'analyse.field': 'Mapa de um campo', 'analyse.start': 'Começar', 'analyse.direction': 'Direção do campo, graus', 'analyse.video': 'Vídeo ou gravação', 'analyse.reference': 'Referência', 'analyse.study': 'Estudo', 'analyse.rig': 'Bobinas',
  'form.number': 'precisa ser um número', 'form.unit': 'precisa de uma unidade como {unit}', 'form.whole': 'precisa ser um número inteiro', 'form.least': 'precisa ser no mínimo {limit}', 'form.most': 'precisa ser no máximo {limit}', 'form.source': 'fonte: {source}', 'form.reset': 'Voltar ao valor usual', 'form.add': 'Acrescentar', 'form.remove': 'Remover', 'form.none': 'nenhum', 'form.pair': 'precisa de dois números, x e y, em cada linha', 'form.type': 'tipo', 'form.preset': 'predefinição', 'form.no_preset': 'valores próprios',
  'view.label': 'O enxame como o microscópio o vê',
  'language': 'Idioma', 'theme': 'Claro ou escuro', 
};

export type Language = 'en' | 'pt';
export const kWords: Record<Language, Record<Word, string>> = { en, pt };

export function words(language: Language) {
  return (key: Word, values: Record<string, string | number> = {}) =>
    kWords[language][key].replace(/\{(\w+)\}/g, (all, name) => (name in values ? String(values[name]) : all));
}
export type Say = ReturnType<typeof words>;
